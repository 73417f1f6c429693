/// @file
/// Statistics of how long something took lately.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace spindrift {

/// Keeps the last `capacity` durations.
class RecentDurations {
 public:
  explicit RecentDurations(std::size_t capacity) : capacity_{capacity} {}

  void add(double duration_ms);

  /// Returns the nearest-rank percentile, ms: the smallest duration that `percent` % of the
  /// durations do not exceed. Empty before the first.
  std::optional<double> percentile_ms(std::size_t percent) const;

 private:
  std::size_t capacity_;
  std::size_t oldest_ = 0;
  std::vector<double> durations_ms_;
};

}  // namespace spindrift
