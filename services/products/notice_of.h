/// @file
/// Converts a warning to the notice in the archive.

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/time/tai_time.h"
#include "services/products/run_notice.h"

namespace spindrift {

/// @param values The values of `warn` (base/warning.h), as are `code` and `text`.
/// @param t      When the notice became true, as in RunNotice.
inline RunNotice notice_of(std::string_view code, const nlohmann::json& values,
                           const std::string& text, std::optional<TaiTime> t = std::nullopt) {
  return {.t = t,
          .code = std::string{code},
          .arguments = values.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
          .says = text};
}

}  // namespace spindrift
