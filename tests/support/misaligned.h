/// @file
/// Mission files that are off by given errors.

#pragma once

#include "pipelines/frames/angle.h"
#include "pipelines/spin/types/config.h"

namespace spindrift::testing {

/// Returns the covariance of independent errors: slits, mounting angles and azimuths off by this,
/// the CO2 altitude by that, and times exact.
inline SpinAlignment independent_alignment(double angle_rad, double co2_km) {
  SpinAlignmentVector sigmas = SpinAlignmentVector::Constant(angle_rad);
  sigmas[Co2AltitudeError] = co2_km;
  sigmas[TimeTagError] = 0.0;
  return sigmas.cwiseAbs2().asDiagonal();
}

/// Returns the defaults of the mission file.
inline SpinAlignment usual_alignment() { return independent_alignment(0.05 * kRadPerDeg, 3.0); }

/// Returns the true values where the mission file is off by these errors, but for the time tag.
inline SpinConfig true_config(SpinConfig said, const SpinAlignmentVector& errors) {
  said.sun_sensor.slit_cant_rad += errors[SlitCantError];
  said.sun_sensor.slit_separation_rad += errors[SlitSeparationError];
  said.north->mount_angle_rad += errors[NorthMountAngleError];
  said.south->mount_angle_rad += errors[SouthMountAngleError];
  said.north->azimuth_rad += errors[NorthAzimuthError];
  said.south->azimuth_rad += errors[SouthAzimuthError];
  said.horizon.co2_altitude_km += errors[Co2AltitudeError];
  return said;
}

}  // namespace spindrift::testing
