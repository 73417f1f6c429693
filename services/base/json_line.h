/// @file
/// Writes JSON for other programs.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace spindrift {

/// Returns one line. Invalid UTF-8 in external text, such as paths, is replaced.
inline std::string json_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace spindrift
