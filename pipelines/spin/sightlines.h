/// @file
/// Where Sun and Earth stood for one revolution.

#pragma once

#include <Eigen/Core>

namespace spindrift {

struct Sightlines {
  Eigen::Vector3d sun_icrf;         ///< Unit, apparent, at sun1.
  Eigen::Vector3d earth_icrf;       ///< Unit, to the Earth's centre, at mid-chord.
  double disc_rad;                  ///< rho, half-angle of the Earth's disc.
  Eigen::Vector3d earth_pole_icrf;  ///< Unit.
};

}  // namespace spindrift
