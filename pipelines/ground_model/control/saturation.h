/// @file
/// Limits for vectors that keep the direction.

#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace spindrift {

/// Scales the vector so that no element exceeds `most`, which must be above 0.
template <class Vector>
Vector within_largest(const Vector& vector, double most) {
  return vector / std::max(1.0, vector.template lpNorm<Eigen::Infinity>() / most);
}

/// Scales the vector so that its length does not exceed `most`, which must be above 0.
inline Eigen::Vector3d within_length(const Eigen::Vector3d& vector, double most) {
  return vector / std::max(1.0, vector.norm() / most);
}

}  // namespace spindrift
