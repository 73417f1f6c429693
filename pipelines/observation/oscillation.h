/// @file
/// Detects residuals that oscillate about a middle value, due to excess noise or to an unmodelled
/// motion such as nutation, in which the axis that slits and beams sense circles the angular
/// momentum. A gate of fixed width would keep one side of the oscillation and bias the estimate.
/// Residuals on one side only are not an oscillation but an offset of the estimate or sensor.

#pragma once

#include <deque>

namespace spindrift {

class Oscillation {
 public:
  /// @param whitened Residual in standard deviations, whether it was used or not.
  void add(double whitened);

  /// Returns the ratio of recent to stated variance by the quartiles, which ignore single spurious
  /// values; 1 unless the residuals oscillate significantly.
  double noise() const { return noise_; }

 private:
  std::deque<double> recent_;
  int stale_ = 0;  ///< Number of values since `noise_` was computed.
  double noise_ = 1.0;
};

}  // namespace spindrift
