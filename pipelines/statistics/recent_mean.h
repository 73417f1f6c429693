/// @file
/// The mean of recent values: the plain mean of the first ones, then an exponential average.

#pragma once

#include <algorithm>

namespace spindrift {

class RecentMean {
 public:
  /// @param window Largest effective number of values; a new value weighs at least 1/window.
  /// @param count Weight of an initial mean of 0, as a number of values.
  explicit RecentMean(double window, double count = 0.0) : window_{window}, count_{count} {}

  /// @param sum Sum of `count` values; the count may be 0.
  void add(double sum, double count = 1.0) {
    if (count > 0.0) {
      count_ = std::min(count_ + count, window_);
      mean_ += (sum - count * mean_) / count_;
    }
  }

  /// Limits the weight of the values so far to that of `count` values.
  void fade(double count) { count_ = std::min(count_, count); }
  void limit(double mean) { mean_ = std::min(mean_, mean); }

  double mean() const { return mean_; }
  /// Returns the effective number of values, at most the window.
  double count() const { return count_; }

 private:
  double window_;
  double count_;
  double mean_ = 0.0;
};

}  // namespace spindrift
