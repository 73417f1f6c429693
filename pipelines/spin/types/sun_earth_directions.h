/// @file
/// Directions to Sun and Earth for one revolution.

#pragma once

#include <Eigen/Core>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct SunEarthDirections {
  Eigen::Vector3d sun_icrf;         ///< Unit, apparent, at sun1.
  Eigen::Vector3d earth_icrf;       ///< Unit, to the Earth's centre, at `t_earth`.
  double disc_rad;                  ///< rho, half-angle of the Earth's disc.
  Eigen::Vector3d earth_pole_icrf;  ///< Unit.
  TaiTime t_earth = {};             ///< Time half way between the chords.
  /// Apparent velocity of the Earth, in ranges per second.
  Eigen::Vector3d earth_motion_icrf_s = Eigen::Vector3d::Zero();
};

}  // namespace spindrift
