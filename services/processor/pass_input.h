/// @file
/// Samples on their way to the computing side of a run.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/operator_action.h"
#include "services/telemetry/sender_names.h"

namespace spindrift {

/// What a pass is to work on next.
struct PassInput {
  std::size_t spacecraft = 0;                ///< Index of its mission.
  std::string run_id;                        ///< Another one than before: a new pass begins.
  TelemetryValues values = {};               ///< `arrival`: the place of each among all in here.
  std::vector<OperatorAction> actions = {};  ///< Likewise, in a place of their own.
  std::vector<std::int64_t> silences = {};   ///< Each before what has that place.
  NamesOfSenders senders = {};               ///< Of those of `values`.
  /// When the last of it came. Empty: it came before a restart, or nothing came that made it due.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

inline std::size_t sample_count(const PassInput& input) { return count_of(input.values); }

/// Of what comes next.
inline std::int64_t next_place(const PassInput& input) {
  return static_cast<std::int64_t>(sample_count(input) + input.actions.size());
}

inline bool is_empty(const PassInput& input) {
  return next_place(input) == 0 && input.silences.empty();
}

}  // namespace spindrift
