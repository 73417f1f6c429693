/// @file
/// Position and velocity of the spacecraft relative to the Earth's centre.

#pragma once

#include <Eigen/Core>

namespace spindrift {

struct OrbitState {
  Eigen::Vector3d position_icrf_km;
  Eigen::Vector3d velocity_icrf_km_s;
};

}  // namespace spindrift
