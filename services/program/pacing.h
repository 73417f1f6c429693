/// @file
/// Paces samples by their own time stamps.

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Makes the first sample due at once, and later ones after the time difference over the speed.
class Pacing {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param speed Multiple of real time; 0 makes everything due at once.
  explicit Pacing(double speed) : speed_{speed} {}

  /// Sets the reference so that a sample of time `t` is due at `instant`.
  void begin_at(TaiTime t, Clock::time_point instant) {
    first_ = t;
    start_ = instant;
  }

  /// Returns when a sample of time `t` is due; empty when that is now or has passed.
  std::optional<Clock::time_point> due(TaiTime t);

  /// Blocks until `due` or until a stop is requested.
  void wait_until(Clock::time_point due, const std::stop_token& stop);

 private:
  double speed_;
  std::optional<TaiTime> first_;
  Clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
};

}  // namespace spindrift
