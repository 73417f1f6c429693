/// @file
/// Conversions for quaternions as Ceres stores them: x y z w, on ceres::EigenQuaternionManifold.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

inline Eigen::Quaterniond quaternion_at(const double* at) {
  return Eigen::Quaterniond{Eigen::Map<const Eigen::Vector4d>{at}};
}

/// Converts derivatives with respect to small body rotations to derivatives with respect to the
/// quaternion, along its tangent.
/// @param jacobian Row-major 3 x 4 output; ignored if null.
inline void write_slopes(const Eigen::Matrix3d& slopes, const Eigen::Quaterniond& q,
                         double* jacobian) {
  if (jacobian == nullptr) {
    return;
  }
  Eigen::Matrix<double, 3, 4> rotation_per_quaternion;
  rotation_per_quaternion << q.w(), q.z(), -q.y(), -q.x(),  //
      -q.z(), q.w(), q.x(), -q.y(),                         //
      q.y(), -q.x(), q.w(), -q.z();
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>{jacobian} =
      2.0 * slopes * rotation_per_quaternion;
}

}  // namespace spindrift
