/// @file
/// Sun, Earth's pole and orbit state during one revolution; the directions to Sun and Earth in it.

#pragma once

#include <Eigen/Core>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Sky about `t`, valid for a minute: the Sun stands still (1 deg a day is 0.0007 deg a minute).
struct Sky {
  TaiTime t;
  OrbitState spacecraft;            ///< Orbit state at `t`.
  Eigen::Vector3d sun_icrf;         ///< Unit, apparent.
  Eigen::Vector3d earth_pole_icrf;  ///< Unit vector.
};

/// Returns Earth's centre -> spacecraft at a time near that of the sky: free fall, second order.
inline Eigen::Vector3d spacecraft_icrf_km(const Sky& sky, TaiTime t) {
  const double dt_s = seconds_between(sky.t, t);
  const Eigen::Vector3d& position_km = sky.spacecraft.position_icrf_km;
  const double range_km = position_km.norm();
  const double fall_per_km = 0.5 * kEarthMu_km3_s2 * dt_s * dt_s / (range_km * range_km * range_km);
  return (1.0 - fall_per_km) * position_km + dt_s * sky.spacecraft.velocity_icrf_km_s;
}

/// Directions to Sun and Earth for one revolution.
struct SunEarthDirections {
  Eigen::Vector3d sun_icrf;         ///< Unit, apparent, at sun1.
  Eigen::Vector3d earth_icrf;       ///< Unit, to the Earth's centre, at `t_earth`.
  double disc_rad;                  ///< rho, half-angle of the Earth's disc.
  Eigen::Vector3d earth_pole_icrf;  ///< Unit vector.
  TaiTime t_earth = {};             ///< Time half way between the chords.
  /// Apparent velocity of the Earth, in ranges per second.
  Eigen::Vector3d earth_motion_icrf_s = Eigen::Vector3d::Zero();
};

}  // namespace spindrift
