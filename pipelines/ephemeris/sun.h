/// @file
/// The apparent Sun as a spacecraft near the Earth sees it, unless it is in the Earth's shadow.
///
/// Computed by ERFA's eraEpv00: within 11.2 km of DE405 from 1900 to 2100 (note 4 of that
/// function), which is 0.015 arcsec; twice that by 1800 and 2200. TAI + 32.184 s is used for TDB:
/// they differ by less than 2 ms, 60 m of the Earth's motion.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The Earth's motion relative to the Sun, and its velocity relative to the barycentre.
struct EarthMotion {
  Eigen::Vector3d heliocentric_icrf_km;
  Eigen::Vector3d heliocentric_icrf_km_s;
  Eigen::Vector3d barycentric_icrf_km_s;
};
EarthMotion earth_motion(TaiTime t);

/// Returns the geometric position of the Sun relative to the Earth's centre at `t`, ICRF, km.
Eigen::Vector3d geometric_sun_icrf_km(TaiTime t);

/// Computes directions to the apparent Sun. The Earth's motion is evaluated at full hours of TAI
/// and interpolated (error below 1 m), because ERFA's series is expensive. The last interval is
/// cached; the result is bit-identical.
class ApparentSun {
 public:
  /// Returns the unit vector spacecraft -> Sun, ICRF, with light time, annual aberration and the
  /// parallax of the spacecraft. The spacecraft's own velocity (up to 7 arcsec) is left out.
  Eigen::Vector3d direction_icrf(TaiTime t, const OrbitState& spacecraft);

 private:
  EarthMotion interpolated_earth(TaiTime t);

  std::optional<std::int64_t> hour_;  ///< Hours of TAI since 1970; empty: no interval yet.
  EarthMotion at_hour_;
  EarthMotion at_next_hour_;
};

/// Returns whether the Sun's centre is behind the Earth, taken as a sphere of the equatorial radius
/// without air. In a low orbit the times are right within seconds. A Sun that is partly covered,
/// before and after, appears displaced by up to a quarter of a degree.
/// @param sun_icrf Unit vector spacecraft -> Sun.
bool is_in_shadow(const Eigen::Vector3d& position_icrf_km, const Eigen::Vector3d& sun_icrf);

}  // namespace spindrift
