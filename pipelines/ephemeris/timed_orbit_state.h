/// @file
/// Position and velocity as a spacecraft says them itself.

#pragma once

#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct TimedOrbitState {
  TaiTime t;
  OrbitState state{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

}  // namespace spindrift
