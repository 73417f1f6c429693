/// @file
/// A planned pass for people and for programs.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "services/reports/planned_pass.h"

namespace spindrift {

/// One line: from when to when, about which axis, how fast.
std::string title_of(const PlannedPass& pass);

/// A table of the steps, then what holds from when to when.
std::string to_text(const PlannedPass& pass);

/// Angles in deg; null where there is none.
nlohmann::json to_json(const PlannedPass& pass);

}  // namespace spindrift
