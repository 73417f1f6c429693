/// @file
/// Plot of a reconstructed separation.

#pragma once

#include <string>

#include "services/reports/separation_report.h"

namespace spindrift {

/// Returns a self-contained SVG: attitude with its uncertainty from separation to the last star
/// fix, over UTC, with the events marked. Empty where the history is of one instant.
std::string plot_of(const SeparationReport& report);

}  // namespace spindrift
