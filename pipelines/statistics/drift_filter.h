/// @file
/// A quantity that changes evenly but for a slow drift: three states, value, change and bend (the
/// change of the change), the last two of which wander. The abscissa is whatever it is measured
/// over: turns or seconds.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// One standard deviation each.
struct DriftNoise {
  double measured;           ///< Of one measurement.
  double wander;             ///< By which the change itself changes along one unit of the abscissa.
  double bend_wander = 0.0;  ///< The same of the bend.
};

/// How far from the expectation a measurement may lie.
struct DriftGate {
  double sigma;  ///< In standard deviations of the difference.
  double most;   ///< In any case.
};

/// What is known at an abscissa, with its standard deviations.
struct DriftState {
  double x;
  double value;
  double value_sigma;
  double change;
  double change_sigma;
  double bend = 0.0;
  double bend_sigma = 0.0;
  double scale = 1.0;  ///< By which the scatter exceeds the stated noise, at least 1.
};

/// Kalman filter with an innovation gate. The stated noise is a lower bound: where the measurements
/// scatter more, the gate opens until half of them lie where half of them should.
class DriftFilter {
 public:
  explicit DriftFilter(const DriftState& state);

  double at(double x) const;
  /// Where the value is reached, next to the last abscissa that was taken in; where it never is,
  /// where it comes nearest. The change must be positive there.
  double x_of(double value) const;
  /// At the last abscissa that was taken in.
  double value() const { return state_[0]; }
  double change() const { return state_[1]; }
  double bend() const { return state_[2]; }
  double change_at(double x) const { return state_[1] + state_[2] * (x - x_); }
  double scale() const { return scale_; }
  /// Standard deviation of the value.
  double sigma_at(double x, const DriftNoise& noise) const;
  /// The same of the change; before the last abscissa at least as much as there.
  double change_sigma_at(double x, const DriftNoise& noise) const;

  /// Whether the measurement lies within the gate.
  bool accepts(double x, double measured, const DriftNoise& noise, const DriftGate& gate) const;
  /// The same, and takes it in when it does.
  bool follow(double x, double measured, const DriftNoise& noise, const DriftGate& gate);

  /// The same, had the bend been measured besides.
  DriftFilter supposing_bend(double bend, double sigma) const;

  /// Moves value (at `x`) and change.
  void shift(double x, double value, double change);
  /// Adds independent errors at the last abscissa, one sigma each.
  void loosen(double value_sigma, double change_sigma, double bend_sigma);

 private:
  Eigen::Matrix3d covariance_at(double x, const DriftNoise& noise) const;

  double x_;
  Eigen::Vector3d state_;
  Eigen::Matrix3d covariance_;
  double scale_;
};

}  // namespace spindrift
