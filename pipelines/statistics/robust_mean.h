/// @file
/// Mean and scatter of a window of values of which some are wrong (rationality tests, Wang 2015).

#pragma once

#include <cstddef>
#include <vector>

namespace spindrift {

/// How far from the mean a value may lie.
struct ClipRule {
  double sigma;   ///< In empirical standard deviations.
  double stated;  ///< Standard deviation that the noise model states; same unit as the values.
};

struct RobustMean {
  double mean;
  double sigma;  ///< Standard deviation of the values kept.
  double limit;  ///< |value - mean| beyond this is an outlier.
  std::size_t kept;

  bool keeps(double value) const;
};

/// Robust mean of the last `length` values of a sequence, kept in order of size: a value more costs
/// a few passes over the window, without sorting and without allocation.
///
/// Starts at median and MAD, then mean and standard deviation of what lies within the limit, until
/// the set no longer changes.
///
/// A value within one stated sigma of the mean is never an outlier: without that floor, values on a
/// coarse telemetry grid would reject each other. With fewer than ten values the empirical scatter
/// is itself uncertain by a quarter, and the floor is `rule.sigma` stated sigmas.
class SlidingRobustMean {
 public:
  /// @param length At least one.
  explicit SlidingRobustMean(std::size_t length);

  /// @param value Finite.
  void add(double value);
  /// Of at least one value.
  RobustMean mean(const ClipRule& rule) const;
  std::size_t size() const { return sorted_.size(); }

 private:
  std::vector<double> ring_;  ///< In the order they came, the oldest at next_ once it is full.
  std::size_t length_;
  std::size_t next_ = 0;
  std::vector<double> sorted_;
};

}  // namespace spindrift
