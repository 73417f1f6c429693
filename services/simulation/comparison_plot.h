/// @file
/// Flight and model over time, drawn as an SVG page.

#pragma once

#include <string>
#include <vector>

#include "services/simulation/comparison_report.h"

namespace spindrift {

/// Returns an SVG: for each sensor the values of flight over those of the model, and the residuals
/// in sigma with the band. Starts of departures are marked.
/// @param samples In the order in which they were compared; at least one has a value.
std::string plot_of(const ComparisonReport& report, const std::vector<ComparedSample>& samples);

}  // namespace spindrift
