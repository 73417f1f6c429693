/// @file
/// Computes how much a count rose in the last minute.

#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Tracks a count that starts at 0.
class RiseOfLastMinute {
 public:
  /// @param t Later than the previous one. @return Rise; 0 if the count has fallen.
  double rise_at(TaiTime t, std::int64_t count) {
    while (!counts_.empty() && seconds_between(counts_.front().t, t) >= kMinute_s) {
      before_ = counts_.front().count;
      counts_.pop_front();
    }
    counts_.push_back({.t = t, .count = count});
    return static_cast<double>(std::max<std::int64_t>(count - before_, 0));
  }

 private:
  static constexpr double kMinute_s = 60.0;
  struct Seen {
    TaiTime t;
    std::int64_t count;
  };
  std::deque<Seen> counts_;
  std::int64_t before_ = 0;  ///< Count a minute ago.
};

}  // namespace spindrift
