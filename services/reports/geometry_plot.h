/// @file
/// Plot of a planned pass.

#pragma once

#include <string>

#include "services/reports/planned_pass.h"

namespace spindrift {

/// Returns an SVG: angles, chords, |Delta|, expected sigma, and what each sensor sees, over UTC.
std::string plot_of(const PlannedPass& pass);

}  // namespace spindrift
