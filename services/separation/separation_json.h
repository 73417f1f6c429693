/// @file
/// A reconstructed separation for programs.

#pragma once

#include <nlohmann/json_fwd.hpp>

#include "services/separation/separation_report.h"

namespace spindrift {

/// services/spindrift/json.md
nlohmann::json to_json(const SeparationReport& report);

}  // namespace spindrift
