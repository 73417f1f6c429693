/// @file
/// A comparison as text for people, and as JSON.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/simulation/comparison_report.h"

namespace spindrift {

/// A row a channel, and a line a departure.
std::string to_text(const ComparisonReport& report);

/// services/program/json.md
nlohmann::json to_json(const ComparisonReport& report);

}  // namespace spindrift
