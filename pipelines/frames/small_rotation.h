/// @file
/// Rotations of a few degrees by their rotation vector, and their derivative by it.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {

/// Returns the rotation; exactly the identity for zero.
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
