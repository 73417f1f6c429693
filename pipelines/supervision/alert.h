/// @file
/// An alert in its state after the last change.

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

/// An operator's acceptance of an alert.
struct Acknowledgement {
  std::string by;
  TaiTime t;
};

struct Alert {
  std::string alert_id = {};  ///< Identifies one occurrence.
  std::string key = {};
  AlertSeverity severity = AlertSeverity::Info;
  AlertState state = AlertState::Active;
  std::int64_t revision = 1;  ///< Rises with every change.
  TaiTime raised = {};
  TaiTime updated = {};                  ///< Time of the last change.
  std::optional<TaiTime> returned = {};  ///< Time at which the condition last returned.
  std::optional<TaiTime> cleared = {};
  std::optional<TaiTime> shelved_until = {};  ///< Belongs to the key: a cleared alert keeps it.
  std::optional<Acknowledgement> accepted = {};
  std::int64_t count = 1;     ///< How often the condition of this key has begun so far.
  std::string message = {};   ///< Text for operators.
  std::string evidence = {};  ///< A JSON object.
  /// @name The last change
  /// @{
  std::optional<AlertState> from = {};  ///< Previous state; empty when the alert was raised.
  std::string by = {};                  ///< Empty when only the message has changed.
  std::string note = {};
  /// @}
};

}  // namespace spindrift
