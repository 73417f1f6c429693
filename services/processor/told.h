/// @file
/// What a person is told of a run, which the archive keeps.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/time/tai_time.h"
#include "services/products/run_notice.h"

namespace spindrift {

/// Warns (standard_error/warning.h). @param t As RunNotice. @return as notice_of.
RunNotice told(std::string_view code, const nlohmann::json& values, const std::string& text,
               std::optional<TaiTime> t = std::nullopt);

}  // namespace spindrift
