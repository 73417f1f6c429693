/// @file
/// Warnings that do not stop the work: for people in the log, for programs under `warnings` in the
/// JSON output of a command.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace spindrift {

/// Logs a warning; safe to call from any thread. `with_warnings` gets the first thousand.
/// @param code Stable name in words with underscores, "bad_rows". @param values A JSON object.
void warn(std::string_view code, nlohmann::json values, std::string text);

/// @return `object` with `warnings`: `code`, `values` and `text` of each so far, in their order.
nlohmann::json with_warnings(nlohmann::json object);

}  // namespace spindrift
