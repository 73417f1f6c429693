/// @file
/// Notices to the user about a run, which the archive keeps.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/time/tai_time.h"
#include "services/products/run_notice.h"

namespace spindrift {

/// Issues a warning (services/base/warning.h) and returns it as a product.
/// @param t Time from which it holds; empty when it holds for the whole run (RunNotice).
RunNotice told(std::string_view code, const nlohmann::json& values, const std::string& text,
               std::optional<TaiTime> t = std::nullopt);

}  // namespace spindrift
