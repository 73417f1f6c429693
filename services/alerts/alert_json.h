/// @file
/// An alert as JSON for other programs.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/base/parsed_json.h"
#include "services/products/alert.h"
#include "services/products/to_json.h"

namespace spindrift {

/// Returns the archive's row with the evidence as a JSON object.
inline nlohmann::json alert_json(const std::string& spacecraft, const std::string& run_id,
                                 const Alert& alert) {
  nlohmann::json object = json_of(alert);
  object["spacecraft_id"] = spacecraft;
  object["run_id"] = run_id;
  object["evidence"] = parsed_json(alert.evidence);
  return object;
}

}  // namespace spindrift
