/// @file
/// Rotations by their rotation vector: along the axis, with the angle as its length.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace spindrift {

/// Returns the matrix with cross_matrix(a) b = a x b.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d cross;
  cross << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),       //
      -a.y(), a.x(), 0.0;
  return cross;
}

/// Returns the unit quaternion that turns by `vector_rad`, of any length.
inline Eigen::Quaterniond quaternion_by(const Eigen::Vector3d& vector_rad) {
  constexpr double kSeries_rad = 1e-3;  // The next term of the series is then 1e-17.
  const double angle_rad = vector_rad.norm();
  const double sine_per_rad = angle_rad < kSeries_rad ? 0.5 - angle_rad * angle_rad / 48.0
                                                      : std::sin(0.5 * angle_rad) / angle_rad;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle_rad);
  q.vec() = sine_per_rad * vector_rad;
  return q;
}

/// Returns the rotation vector, at most pi long, of `q` (any length); `-q` is the same rotation.
inline Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine == 0.0) {
    return Eigen::Vector3d::Zero();
  }
  const double half_angle_rad = std::atan2(sine, std::abs(q.w()));
  return (q.w() < 0.0 ? -2.0 : 2.0) * half_angle_rad / sine * q.vec();
}

/// The right Jacobian J of SO(3): quaternion_by(v + dv) = quaternion_by(v) quaternion_by(J dv).
inline Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& vector_rad) {
  constexpr double kSeries_rad = 1e-2;  // The next terms of the series are then 1e-11.
  const double angle_rad = vector_rad.norm();
  const Eigen::Matrix3d cross = cross_matrix(vector_rad);
  if (angle_rad < kSeries_rad) {
    return Eigen::Matrix3d::Identity() - (0.5 - angle_rad * angle_rad / 24.0) * cross +
           (1.0 / 6.0 - angle_rad * angle_rad / 120.0) * cross * cross;
  }
  const double square = angle_rad * angle_rad;
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(angle_rad)) / square * cross +
         (angle_rad - std::sin(angle_rad)) / (square * angle_rad) * cross * cross;
}

/// Returns the inverse J of the right Jacobian: rotation_vector_of(quaternion_by(v)
/// quaternion_by(e)) = v + J e, for vectors shorter than a turn.
inline Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& vector_rad) {
  constexpr double kSeries_rad = 1e-2;
  const double squared = vector_rad.squaredNorm();
  const double angle = std::sqrt(squared);
  const double second = angle < kSeries_rad
                            ? 1.0 / 12.0 + squared / 720.0 + squared * squared / 30240.0
                            : 1.0 / squared - 0.5 / (angle * std::tan(0.5 * angle));
  const Eigen::Matrix3d cross = cross_matrix(vector_rad);
  return Eigen::Matrix3d::Identity() + 0.5 * cross + second * cross * cross;
}

/// Returns the angle between two attitudes, [0, pi].
inline double angle_between_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return rotation_vector_of(a.conjugate() * b).norm();
}

/// Returns the rotation matrix; exactly the identity for zero.
inline Eigen::Matrix3d rotation_by(const Eigen::Vector3d& vector_rad) {
  if (vector_rad.isZero(0.0)) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd{vector_rad.norm(), vector_rad.stableNormalized()}.toRotationMatrix();
}

/// Returns the left Jacobian J of SO(3), rotation_by(v + dv) = rotation_by(J dv) rotation_by(v), to
/// second order in v: 2e-7 at a degree.
inline Eigen::Matrix3d rotation_per_vector(const Eigen::Vector3d& vector_rad) {
  const Eigen::Matrix3d cross = cross_matrix(vector_rad);
  return Eigen::Matrix3d::Identity() + 0.5 * cross + cross * cross / 6.0;
}

}  // namespace spindrift
