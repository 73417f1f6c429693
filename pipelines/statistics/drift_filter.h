/// @file
/// Filters a quantity with a slowly drifting rate of change. Its states are value, change and bend
/// (the change of the change); change and bend follow random walks. The abscissa is turns or time.

#pragma once

#include <Eigen/Core>
#include <cmath>

namespace spindrift {

/// Standard deviations of the noise.
struct DriftNoise {
  double measured;           ///< Noise of one measurement.
  double wander;             ///< Random walk of the change over one unit of the abscissa.
  double bend_wander = 0.0;  ///< Random walk of the bend over one unit of the abscissa.
};

/// The largest deviation of a measurement from its prediction.
struct DriftGate {
  double sigma;  ///< Largest deviation, in its standard deviations.
  double most;   ///< Absolute limit.
};

/// A measurement against the filter's expectation, in its unit.
struct DriftTest {
  double off;    ///< Measured minus expected.
  double sigma;  ///< Standard deviation of `off`.
  double limit;  ///< Largest absolute `off` within the gate.
  bool passed() const { return std::abs(off) <= limit; }
};

/// The state at an abscissa, with standard deviations.
struct DriftState {
  double x;
  double value;
  double value_sigma;
  double change;
  double change_sigma;
  double bend = 0.0;
  double bend_sigma = 0.0;
  double scale = 1.0;  ///< Ratio of scatter to stated noise, at least 1.
};

/// Kalman filter with an innovation gate. The stated noise is a lower bound: the gate widens until
/// half of the measurements lie within the median deviation.
class DriftFilter {
 public:
  explicit DriftFilter(const DriftState& state);

  double at(double x) const;
  /// Returns the abscissa, next to the last one processed, where the value is reached or, if it
  /// never is, approached most closely. The change must be positive there.
  double x_of(double value) const;
  /// The state at the last abscissa processed.
  double value() const { return state_[0]; }
  double change() const { return state_[1]; }
  double bend() const { return state_[2]; }
  double change_at(double x) const { return state_[1] + state_[2] * (x - x_); }
  double scale() const { return scale_; }
  /// Returns the standard deviation of the value.
  double sigma_at(double x, const DriftNoise& noise) const;
  /// Returns the standard deviation of the change; before the last abscissa at least that there.
  double change_sigma_at(double x, const DriftNoise& noise) const;

  /// Returns whether a measurement lies within the gate.
  DriftTest test(double x, double measured, const DriftNoise& noise, const DriftGate& gate) const;
  /// Tests a measurement and processes it if it lies within the gate.
  DriftTest follow(double x, double measured, const DriftNoise& noise, const DriftGate& gate);

  /// Returns the filter as if the bend had been measured in addition.
  DriftFilter supposing_bend(double bend, double sigma) const;

  /// Shifts the value at `x` and the change.
  void shift(double x, double value, double change);
  /// Adds independent errors at the last abscissa, given as standard deviations.
  void loosen(double value_sigma, double change_sigma, double bend_sigma);

 private:
  Eigen::Matrix3d covariance_at(double x, const DriftNoise& noise) const;

  double x_;
  Eigen::Vector3d state_;
  Eigen::Matrix3d covariance_;
  double scale_;
};

}  // namespace spindrift
