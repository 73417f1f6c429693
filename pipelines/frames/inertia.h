/// @file
/// Check of a matrix of inertia.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// Returns whether a body can have this matrix of inertia: symmetric, with positive principal
/// moments, none above the sum of the other two; to 1e-9 of the greatest.
bool is_inertia(const Eigen::Matrix3d& matrix);

}  // namespace spindrift
