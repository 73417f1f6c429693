/// @file
/// Test whether the spacecraft is in the Earth's shadow.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// Returns whether the Sun's centre is behind the Earth, taken as a sphere of the equatorial radius
/// without air. In a low orbit the times are right within seconds. A Sun that is partly covered,
/// before and after, appears displaced by up to a quarter of a degree.
/// @param sun_icrf Unit vector spacecraft -> Sun.
bool is_in_shadow(const Eigen::Vector3d& position_icrf_km, const Eigen::Vector3d& sun_icrf);

}  // namespace spindrift
