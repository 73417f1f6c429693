/// @file
/// What somebody should look at, though the work goes on: for people in the log, for programs under
/// `warnings` of what a command prints as JSON.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace spindrift {

/// From any thread. The first thousand of a process are kept for `with_warnings`.
/// @param code Stable, in words with underscores: "bad_rows". @param values An object.
void warn(std::string_view code, nlohmann::json values, std::string text);

/// @return `object` with `warnings`: of each so far `code`, `values` and `text`, in their order.
nlohmann::json with_warnings(nlohmann::json object);

}  // namespace spindrift
