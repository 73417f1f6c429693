/// @file
/// Statistics of how long something took lately.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipelines/statistics/median.h"

namespace spindrift {

/// Keeps the last `capacity` durations.
class RecentDurations {
 public:
  explicit RecentDurations(std::size_t capacity) : capacity_{capacity} {}

  void add(double duration_ms) {
    if (durations_ms_.size() < capacity_) {
      durations_ms_.push_back(duration_ms);
      return;
    }
    durations_ms_.at(oldest_) = duration_ms;
    oldest_ = (oldest_ + 1) % capacity_;
  }

  /// Returns the nearest-rank percentile, ms; empty before the first duration.
  std::optional<double> percentile_ms(std::size_t percent) const {
    if (durations_ms_.empty()) {
      return std::nullopt;
    }
    std::vector<double> reordered_ms = durations_ms_;
    return percentile(reordered_ms, percent);
  }

 private:
  std::size_t capacity_;
  std::size_t oldest_ = 0;
  std::vector<double> durations_ms_;
};

}  // namespace spindrift
