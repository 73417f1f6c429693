/// @file
/// A reconstructed separation as a picture.

#pragma once

#include <string>

#include "services/reports/separation_report.h"

namespace spindrift {

/// SVG that stands by itself: attitude with its uncertainty from separation to the last star fix,
/// over UTC, the events marked. Empty where the history is of one instant.
std::string plot_of(const SeparationReport& report);

}  // namespace spindrift
