/// @file
/// Vectors that are too long, made shorter along their direction.

#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace spindrift {

/// No element larger than `most`, above 0.
template <class Vector>
Vector within_largest(const Vector& vector, double most) {
  return vector / std::max(1.0, vector.template lpNorm<Eigen::Infinity>() / most);
}

/// No longer than `most`, above 0.
inline Eigen::Vector3d within_length(const Eigen::Vector3d& vector, double most) {
  return vector / std::max(1.0, vector.norm() / most);
}

}  // namespace spindrift
