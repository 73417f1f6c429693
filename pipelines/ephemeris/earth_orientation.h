/// @file
/// How the Earth stands among the stars.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Precession and nutation IAU 2006/2000A, Earth rotation angle (eraC2t06a); since 1972.
///
/// UT1 is taken for UTC, which turns the Earth by at most 13.5 arcsec (0.9 s) about its pole; polar
/// motion, at most 0.6 arcsec, is left out.
/// @return q_icrf_itrf, from the Earth's axes to ICRF.
Eigen::Quaterniond earth_orientation(TaiTime t);

}  // namespace spindrift
