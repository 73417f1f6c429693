/// @file
/// Requests that change an alert: /api/v1/alerts/ALERT_ID/ack and .../shelve.

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pipelines/core/expected.h"
#include "services/alerts/alert_desk.h"

namespace spindrift {

struct AlertPath {
  std::string alert_id;
  bool shelves;  ///< False when it acknowledges.
};

/// Returns empty for any other path.
std::optional<AlertPath> alert_path(std::string_view path);

/// @param body A JSON object with a non-empty `by`, optionally `note`, and to shelve also
///        `minutes`, 1 to 10080.
/// @return InvalidInput, saying what is wrong.
Expected<OperatorWord> operator_word(const AlertPath& path, std::string_view body);

}  // namespace spindrift
