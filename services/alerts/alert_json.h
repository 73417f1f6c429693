/// @file
/// An alert as programs read it.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/products/alert.h"
#include "services/products/to_json.h"

namespace spindrift {

/// As the archive has it, but the evidence an object.
inline nlohmann::json alert_json(const std::string& spacecraft, const std::string& run_id,
                                 const Alert& alert) {
  nlohmann::json object = json_of(alert);
  object["spacecraft_id"] = spacecraft;
  object["run_id"] = run_id;
  object["evidence"] = nlohmann::json::parse(alert.evidence, nullptr, false);
  return object;
}

}  // namespace spindrift
