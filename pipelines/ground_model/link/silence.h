/// @file
/// Spans of time in which no telemetry arrives.

#pragma once

#include <algorithm>
#include <vector>

namespace spindrift {

/// Nothing arrives from `from_s` up to `to_s`.
struct Silence {
  double from_s;
  double to_s;
};

inline bool is_silent(const std::vector<Silence>& silences, double t_s) {
  return std::any_of(silences.begin(), silences.end(), [t_s](const Silence& silence) {
    return t_s >= silence.from_s && t_s < silence.to_s;
  });
}

}  // namespace spindrift
