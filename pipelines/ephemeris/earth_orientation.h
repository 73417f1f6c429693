/// @file
/// Orientation of the Earth, and its pole, the short axis of the ellipsoid, in ICRF.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the orientation since 1972: IAU 2006/2000A and Earth rotation angle (eraC2t06a). UTC is
/// used for UT1 (error 0.9 s, 13.5 arcsec); polar motion, 0.6 arcsec, is left out.
/// @return q_icrf_itrf, from the Earth's axes to ICRF.
Eigen::Quaterniond earth_orientation(TaiTime t);

/// Fast `earth_orientation`, to 0.02 arcsec; to 15 arcsec within the hour of a leap second. Turns
/// the orientation at the start of the hour of TAI about the Earth's axis. It keeps the last such
/// orientation, which changes the speed and never a bit of the result.
class TurningEarth {
 public:
  /// @return q_icrf_itrf.
  Eigen::Quaterniond orientation(TaiTime t);

 private:
  std::optional<std::int64_t> hour_;  ///< Hours of TAI since 1970; empty: none yet.
  Eigen::Quaterniond q_icrf_at_hour_;
};

/// Returns the mean pole of date, ICRF, unit vector: bias and precession IAU 2006 (eraPmat06).
///
/// Nutation (10 arcsec) and polar motion (0.5 arcsec) are left out: they move the limb of an
/// ellipsoid flattened by 1/298 by less than 0.04 arcsec.
Eigen::Vector3d earth_pole_icrf(TaiTime t);

}  // namespace spindrift
