/// @file
/// Flight and model over time, as a page for people.

#pragma once

#include <string>
#include <vector>

#include "services/simulation/comparison_report.h"

namespace spindrift {

/// SVG: of each sensor what flight gives over what the model does, and the residuals in sigma with
/// the band. Instants of departure are marked.
/// @param samples In the order in which they were compared; some of them have a value.
std::string plot_of(const ComparisonReport& report, const std::vector<ComparedSample>& samples);

}  // namespace spindrift
