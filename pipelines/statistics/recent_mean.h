/// @file
/// The mean of the recent values of a sequence: of the first ones the plain mean, later a mean that
/// forgets.

#pragma once

#include <algorithm>

namespace spindrift {

class RecentMean {
 public:
  /// @param window So many values speak at most: each new one counts 1/window of it.
  /// @param count So many values are taken to have had the mean 0 before the first.
  explicit RecentMean(double window, double count = 0.0) : window_{window}, count_{count} {}

  /// @param sum Of `count` values, which may be none.
  void add(double sum, double count = 1.0) {
    if (count > 0.0) {
      count_ = std::min(count_ + count, window_);
      mean_ += (sum - count * mean_) / count_;
    }
  }

  /// The values so far speak like so many at most.
  void fade(double count) { count_ = std::min(count_, count); }
  void limit(double mean) { mean_ = std::min(mean_, mean); }

  double mean() const { return mean_; }
  /// How many values speak, no more than the window.
  double count() const { return count_; }

 private:
  double window_;
  double count_;
  double mean_ = 0.0;
};

}  // namespace spindrift
