/// @file
/// Attitude and rate of a body at an instant.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

struct BodyState {
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d rate_body_rad_s;
};

}  // namespace spindrift
