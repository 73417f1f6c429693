/// @file
/// Whether the Earth stands before the Sun.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// The Sun's centre lies behind the Earth, a sphere of the equatorial radius without air: within
/// seconds of when it does in a low orbit. Partly covered before and after, it looks up to a
/// quarter of a degree displaced.
/// @param sun_icrf Unit vector spacecraft -> Sun.
bool is_in_shadow(const Eigen::Vector3d& position_icrf_km, const Eigen::Vector3d& sun_icrf);

}  // namespace spindrift
