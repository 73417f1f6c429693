/// @file
/// A low Earth orbit.

#pragma once

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/time/tai_time.h"

namespace spindrift::testing {

/// Returns an orbit at 650 km altitude and 97.9 deg inclination.
/// @param mean_anomaly_rad Mean anomaly at the epoch, rad.
inline Orbit low_orbit(TaiTime epoch, double mean_anomaly_rad = 0.0) {
  return Orbit{KeplerOrbit::make({.epoch = epoch,
                                  .semi_major_axis_km = 7028.137,
                                  .eccentricity = 0.001,
                                  .inclination_rad = 97.9 * kRadPerDeg,
                                  .raan_rad = 10.0 * kRadPerDeg,
                                  .argument_of_perigee_rad = 0.0,
                                  .mean_anomaly_rad = mean_anomaly_rad})
                   .value()};
}

}  // namespace spindrift::testing
