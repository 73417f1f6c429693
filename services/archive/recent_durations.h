/// @file
/// How long something took lately.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace spindrift {

/// The last `capacity` durations, the oldest forgotten first.
class RecentDurations {
 public:
  explicit RecentDurations(std::size_t capacity) : capacity_{capacity} {}

  void add(double duration_ms);

  /// Nearest rank: the smallest duration that so many of a hundred do not exceed, ms. Empty before
  /// the first.
  std::optional<double> percentile_ms(std::size_t percent) const;

 private:
  std::size_t capacity_;
  std::size_t oldest_ = 0;
  std::vector<double> durations_ms_;
};

}  // namespace spindrift
