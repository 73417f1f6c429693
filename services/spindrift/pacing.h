/// @file
/// Samples at the pace of their own time.

#pragma once

#include <chrono>
#include <optional>
#include <thread>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The first sample is due at once, a later one by as much later as its time is, over the speed.
class Pacing {
 public:
  /// @param speed Times real time; 0: everything is due at once.
  explicit Pacing(double speed) : speed_{speed} {}

  void wait_until_due(TaiTime t) {
    if (!(speed_ > 0.0)) {
      return;
    }
    if (!first_) {
      first_ = t;
      start_ = Clock::now();
    }
    const std::chrono::duration<double> elapsed{seconds_between(*first_, t) / speed_};
    std::this_thread::sleep_until(start_ + std::chrono::duration_cast<Clock::duration>(elapsed));
  }

 private:
  using Clock = std::chrono::steady_clock;

  double speed_;
  std::optional<TaiTime> first_;
  Clock::time_point start_;
};

}  // namespace spindrift
