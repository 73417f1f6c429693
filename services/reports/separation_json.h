/// @file
/// Output of a reconstructed separation as JSON.

#pragma once

#include <nlohmann/json_fwd.hpp>

#include "services/reports/separation_report.h"

namespace spindrift {

/// Returns the object described in services/program/json.md.
nlohmann::json to_json(const SeparationReport& report);

}  // namespace spindrift
