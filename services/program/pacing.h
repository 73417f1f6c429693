/// @file
/// Samples at the pace of their own time.

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The first sample is due at once, a later one by as much later as its time is, over the speed.
class Pacing {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param speed Times real time; 0: everything is due at once.
  explicit Pacing(double speed) : speed_{speed} {}

  /// As if `t` had been due at `instant`.
  void begin_at(TaiTime t, Clock::time_point instant) {
    first_ = t;
    start_ = instant;
  }

  /// Empty: now, or the time has passed.
  std::optional<Clock::time_point> due(TaiTime t);

  /// Or until a stop is requested.
  void wait_until(Clock::time_point due, const std::stop_token& stop);

 private:
  double speed_;
  std::optional<TaiTime> first_;
  Clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
};

}  // namespace spindrift
