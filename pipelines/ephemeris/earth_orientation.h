/// @file
/// How the Earth stands among the stars.

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Precession and nutation IAU 2006/2000A, Earth rotation angle (eraC2t06a); since 1972.
///
/// UT1 is taken for UTC, which turns the Earth by at most 13.5 arcsec (0.9 s) about its pole; polar
/// motion, at most 0.6 arcsec, is left out.
/// @return q_icrf_itrf, from the Earth's axes to ICRF.
Eigen::Quaterniond earth_orientation(TaiTime t);

/// The same to 0.02 arcsec, and to 15 arcsec within the hour of a leap second, but cheap.
///
/// Turns the axes of the last hour of TAI about the Earth's own: keeps that hour, which changes
/// speed, never a bit of the result.
class TurningEarth {
 public:
  /// @return q_icrf_itrf.
  Eigen::Quaterniond orientation(TaiTime t);

 private:
  std::optional<std::int64_t> hour_;  ///< Of TAI since 1970; empty: none yet.
  Eigen::Quaterniond q_icrf_at_hour_;
};

}  // namespace spindrift
