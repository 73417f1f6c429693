/// @file
/// A reconstructed separation for programs.

#pragma once

#include <nlohmann/json_fwd.hpp>

#include "services/reports/separation_report.h"

namespace spindrift {

/// services/program/json.md
nlohmann::json to_json(const SeparationReport& report);

}  // namespace spindrift
