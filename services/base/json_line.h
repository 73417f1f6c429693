/// @file
/// What a program reads.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace spindrift {

/// One line. Of text from outside, as of paths, what is no UTF-8 is replaced.
inline std::string json_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace spindrift
