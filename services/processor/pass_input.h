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

struct PassInput {
  std::size_t spacecraft = 0;  ///< Index of the spacecraft's mission.
  std::string run_id;          ///< A change of this begins a new pass.
  PlacedValues values = {};
  /// Each action has a place in the order of `values`.
  std::vector<Placed<OperatorAction>> actions = {};
  std::vector<BatchPlace> silences = {};  ///< Place of the element that follows each silence.
  NamesOfSenders senders = {};            ///< Names of the senders of `values`.
  /// When the last sample came. Empty after a restart, or when no sample made the input due.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

inline std::size_t sample_count(const PassInput& input) { return count_of(input.values); }

/// Returns the place that the next element of this input gets.
inline BatchPlace next_place(const PassInput& input) {
  return {static_cast<std::int64_t>(sample_count(input) + input.actions.size())};
}

inline bool is_empty(const PassInput& input) {
  return next_place(input) == BatchPlace{} && input.silences.empty();
}

}  // namespace spindrift
