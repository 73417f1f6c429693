/// @file
/// A planned pass as a picture.

#pragma once

#include <string>

#include "services/reports/planned_pass.h"

namespace spindrift {

/// SVG that stands by itself: angles, chords, |Delta|, the sigma to expect, and what each sensor
/// sees, one above the other over UTC.
std::string plot_of(const PlannedPass& pass);

}  // namespace spindrift
