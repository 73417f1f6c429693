/// @file
/// A histogram of durations since the start.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spindrift {

/// Counts durations up to bounds, in seconds, that suit commits and latencies.
class DurationHistogram {
 public:
  static constexpr std::array<double, 15> kBounds_s = {
      0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0};

  void add(double duration_s) {
    for (std::size_t i = 0; i < kBounds_s.size(); ++i) {
      counts_[i] += duration_s <= kBounds_s[i] ? 1 : 0;
    }
    ++count_;
    sum_s_ += duration_s;
  }

  /// Returns for each bound how many durations were not above it.
  const std::array<std::uint64_t, kBounds_s.size()>& counts() const { return counts_; }
  std::uint64_t count() const { return count_; }
  double sum_s() const { return sum_s_; }

 private:
  std::array<std::uint64_t, kBounds_s.size()> counts_{};
  std::uint64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace spindrift
