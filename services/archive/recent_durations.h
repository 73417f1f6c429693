/// @file
/// Statistics of how long something took lately.

#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

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

  /// Returns the nearest-rank percentile, ms: the smallest duration that `percent` % of the
  /// durations do not exceed. Empty before the first.
  std::optional<double> percentile_ms(std::size_t percent) const {
    if (durations_ms_.empty()) {
      return std::nullopt;
    }
    std::vector<double> sorted_ms = durations_ms_;
    const std::size_t rank = (sorted_ms.size() * percent + 99) / 100;
    const auto nth = sorted_ms.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(sorted_ms.begin(), nth, sorted_ms.end());
    return *nth;
  }

 private:
  std::size_t capacity_;
  std::size_t oldest_ = 0;
  std::vector<double> durations_ms_;
};

}  // namespace spindrift
