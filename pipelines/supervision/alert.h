/// @file
/// One alert, as it came to be with its last change.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/supervision/alert_code.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class AlertState { Active, Acknowledged, Shelved, Cleared };
constexpr std::string_view name_of(AlertState state) {
  constexpr std::array<std::string_view, 4> kNames = {"active", "acknowledged", "shelved",
                                                      "cleared"};
  return kNames.at(static_cast<std::size_t>(state));
}

struct Alert {
  std::string alert_id = {};  ///< One occurrence.
  std::string key = {};
  AlertSeverity severity = AlertSeverity::Info;
  AlertState state = AlertState::Active;
  std::int64_t revision = 1;  ///< Rises with every change.
  TaiTime raised = {};
  TaiTime updated = {};  ///< Of the last change.
  std::optional<TaiTime> cleared = {};
  std::optional<TaiTime> shelved_until = {};
  std::int64_t count = 1;     ///< The how manyth of its key.
  std::string message = {};   ///< For people.
  std::string evidence = {};  ///< A JSON object.
  /// @name The last change
  /// @{
  std::optional<AlertState> from = {};  ///< Empty: raised.
  std::string by = {};
  std::string note = {};
  /// @}
};

}  // namespace spindrift
