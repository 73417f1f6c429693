/// @file
/// The shortest turn from one direction to another.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// Returns the shortest rotation of `from` into the direction of `to`, both of any length. For
/// opposite directions the axis is any across them.
Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace spindrift
