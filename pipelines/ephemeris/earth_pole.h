/// @file
/// Direction of the Earth's pole, the short axis of the ellipsoid, in ICRF.

#pragma once

#include <Eigen/Core>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the mean pole of date, ICRF, unit vector: bias and precession IAU 2006 (eraPmat06).
///
/// Nutation (10 arcsec) and polar motion (0.5 arcsec) are left out: they move the limb of an
/// ellipsoid flattened by 1/298 by less than 0.04 arcsec.
Eigen::Vector3d earth_pole_icrf(TaiTime t);

}  // namespace spindrift
