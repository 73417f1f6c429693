/// @file
/// Samples on their way to the computing side of a run.

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/telemetry/by_kind.h"

namespace spindrift {

/// What a pass is to work on next.
struct PassInput {
  std::size_t spacecraft = 0;               ///< Index of its mission.
  std::string run_id;                       ///< Another one than before: a new pass begins.
  TelemetryValues values = {};              ///< `arrival`: the place of each among all in here.
  std::vector<std::int64_t> silences = {};  ///< Each before the value of that place.
};

inline std::size_t sample_count(const PassInput& input) { return count_of(input.values); }

inline bool is_empty(const PassInput& input) {
  return sample_count(input) == 0 && input.silences.empty();
}

}  // namespace spindrift
