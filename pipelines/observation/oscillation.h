/// @file
/// Whether the residuals of a source oscillate about a middle: more noise than stated, or a motion
/// that the estimator does not know, as nutation, under which the axis that slits and beams see
/// circles the angular momentum. A gate of fixed width would keep one side of the oscillation and
/// bias the estimate. Residuals that stay on one side do not oscillate: the estimate, or the
/// sensor, is elsewhere.

#pragma once

#include <deque>

namespace spindrift {

class Oscillation {
 public:
  /// @param whitened In standard deviations, whether it was used or not.
  void add(double whitened);

  /// How many times the variance of the recent ones is what it should be, by their quartiles, which
  /// take no notice of single spurious ones; 1 where they do not oscillate significantly.
  double noise() const { return noise_; }

 private:
  std::deque<double> recent_;
  int stale_ = 0;  ///< So many have come since the noise was found.
  double noise_ = 1.0;
};

}  // namespace spindrift
