/// @file
/// Moments of inertia that a body can have.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// Symmetric, with positive principal moments, none above the sum of the other two; to 1e-9 of the
/// greatest.
bool is_inertia(const Eigen::Matrix3d& matrix);

}  // namespace spindrift
