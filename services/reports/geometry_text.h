/// @file
/// Output of a planned pass as text and JSON.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "services/reports/planned_pass.h"

namespace spindrift {

/// Returns one line with the times, the axis and the rate.
std::string title_of(const PlannedPass& pass);

/// Returns a table of the steps, then the conditions with their times.
std::string to_text(const PlannedPass& pass);

/// Returns the pass with angles in deg; null where there is none.
nlohmann::json to_json(const PlannedPass& pass);

}  // namespace spindrift
