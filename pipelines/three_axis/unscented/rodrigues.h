/// @file
/// Generalised Rodrigues parameters of a turn (Crassidis and Markley 2003 with a = 1, f = 4):
///
///     p = 4 tan(angle / 4) axis,
///
/// which is the rotation vector for small turns and singular only at a full turn.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// Returns the unit quaternion of the turn.
inline Eigen::Quaterniond quaternion_of_rodrigues(const Eigen::Vector3d& p) {
  const double square = p.squaredNorm();
  Eigen::Quaterniond q;
  q.w() = (16.0 - square) / (16.0 + square);
  q.vec() = 0.25 * (1.0 + q.w()) * p;
  return q;
}

/// Returns the parameters, at most 4 long, of a unit quaternion; `-q` is the same turn.
inline Eigen::Vector3d rodrigues_of(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  return 4.0 * sign / (1.0 + sign * q.w()) * q.vec();
}

}  // namespace spindrift
