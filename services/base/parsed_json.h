/// @file
/// Reads JSON that comes from outside.

#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace spindrift {

/// Limit on nested arrays and objects, above any need of ours. Deeper ones end a program: they are
/// copied and written by recursion.
inline constexpr int kDeepestJson = 16;

/// Returns a discarded value for what is no JSON or nested too deep.
inline nlohmann::json parsed_json(std::string_view text) {
  bool is_too_deep = false;
  const auto shallow = [&](int depth, nlohmann::json::parse_event_t /*event*/,
                           const nlohmann::json& /*value*/) {
    is_too_deep = is_too_deep || depth > kDeepestJson;
    return !is_too_deep;
  };
  auto value = nlohmann::json::parse(text, shallow, false);
  return is_too_deep ? nlohmann::json(nlohmann::json::value_t::discarded) : value;
}

}  // namespace spindrift
