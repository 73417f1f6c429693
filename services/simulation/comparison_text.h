/// @file
/// Output of a comparison as text and as JSON.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/simulation/comparison_report.h"

namespace spindrift {

/// Returns a table with a row per channel, and a line per departure.
std::string to_text(const ComparisonReport& report);

/// Returns the object described in services/program/json.md.
nlohmann::json to_json(const ComparisonReport& report);

}  // namespace spindrift
