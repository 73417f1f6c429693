/// @file
/// Mean and scatter of a window of values with outliers (rationality tests, Wang 2015).

#pragma once

#include <cstddef>
#include <vector>

namespace spindrift {

/// The largest deviation of a value from the mean.
struct ClipRule {
  double sigma;   ///< Largest deviation, in empirical standard deviations.
  double stated;  ///< Standard deviation that the noise model states; same unit as the values.
};

struct RobustMean {
  double mean;
  double sigma;  ///< Standard deviation of the values kept.
  double limit;  ///< |value - mean| beyond this is an outlier.
  std::size_t kept;

  bool keeps(double value) const;
};

/// Computes the robust mean of the last `length` values. They are kept sorted, so that a new value
/// costs a few passes over the window without sorting or allocation.
///
/// It starts from median and MAD and iterates mean and standard deviation of the values within the
/// limit until the set is stable.
///
/// A value within one stated sigma of the mean is never an outlier. Without that floor, values on a
/// coarse telemetry grid would reject each other. With fewer than ten values the empirical scatter
/// is uncertain by a quarter, and the floor is `rule.sigma` stated sigmas.
class SlidingRobustMean {
 public:
  /// @param length At least one.
  explicit SlidingRobustMean(std::size_t length);

  /// @param value Finite.
  void add(double value);
  /// Precondition: the window is not empty.
  RobustMean mean(const ClipRule& rule) const;
  std::size_t size() const { return sorted_.size(); }

 private:
  std::vector<double> ring_;  ///< In order of arrival; the oldest is at next_ once full.
  std::size_t length_;
  std::size_t next_ = 0;
  std::vector<double> sorted_;
};

}  // namespace spindrift
