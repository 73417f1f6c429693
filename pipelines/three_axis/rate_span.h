/// @file
/// The turn of a body between two samples of its gyro.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// Holds the measured rates at both ends of a time step.
struct RateSpan {
  double dt_s;
  Eigen::Vector3d from_rad_s;
  Eigen::Vector3d to_rad_s;
};

/// Returns the rotation vector of a body whose rate changes linearly, to third order of its angle.
/// The cross product is the second term of the Magnus expansion and accounts for a moving axis.
inline Eigen::Vector3d turned_rad(const RateSpan& span, const Eigen::Vector3d& bias_rad_s) {
  const Eigen::Vector3d from_rad_s = span.from_rad_s - bias_rad_s;
  const Eigen::Vector3d to_rad_s = span.to_rad_s - bias_rad_s;
  return 0.5 * span.dt_s * (from_rad_s + to_rad_s) +
         span.dt_s * span.dt_s / 12.0 * from_rad_s.cross(to_rad_s);
}

/// Holds the process noise of a time step, per axis.
struct SpanErrors {
  double turn_rad2;     ///< Variance of the turn.
  double bias_rad2_s2;  ///< Growth of the variance of the bias.
};

}  // namespace spindrift
