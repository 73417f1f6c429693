/// @file
/// The apparent Sun as a spacecraft near the Earth sees it.
///
/// From ERFA's eraEpv00: within 11.2 km of DE405 from 1900 to 2100 (note 4 of that function), which
/// is 0.015 arcsec; twice that by 1800 and 2200. TAI + 32.184 s is taken for TDB: they differ by
/// less than 2 ms, 60 m of the Earth's way.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The Earth relative to the Sun, and its velocity relative to the solar system's barycentre.
struct EarthMotion {
  Eigen::Vector3d heliocentric_icrf_km;
  Eigen::Vector3d heliocentric_icrf_km_s;
  Eigen::Vector3d barycentric_icrf_km_s;
};
EarthMotion earth_motion(TaiTime t);

/// Geometric Sun relative to the Earth's centre at `t`, ICRF, km.
Eigen::Vector3d geometric_sun_icrf_km(TaiTime t);

/// Directions to the apparent Sun.
///
/// Evaluates the Earth's motion on hourly nodes of TAI and interpolates (below 1 m), because ERFA's
/// series is dear: keeps the last interval, which changes speed, never a bit of the result.
class ApparentSun {
 public:
  /// Unit vector spacecraft -> Sun, ICRF: light time and annual aberration included, parallax of
  /// the spacecraft too. The spacecraft's own velocity (up to 7 arcsec) is left out.
  Eigen::Vector3d direction_icrf(TaiTime t, const OrbitState& spacecraft);

 private:
  EarthMotion interpolated_earth(TaiTime t);

  std::optional<std::int64_t> hour_;  ///< Of TAI since 1970; empty: no interval yet.
  EarthMotion at_hour_;
  EarthMotion at_next_hour_;
};

}  // namespace spindrift
