#include "pipelines/spin/measurement/errors_of_alignment.h"

#include <algorithm>
#include <cmath>

#include "pipelines/spin/sensor_model/horizon.h"

namespace spindrift {
namespace {

/// Returns how much too large the model's disc seems per mounting angle that is larger than stated,
/// from cos(rho) = cos(g) cos(theta_e) + sin(g) cos(Phi/2) sin(theta_e); of a beam beside the disc
/// as if it touched it.
double disc_per_mount_angle(double mount_angle_rad, const SeenByAxis& seen) {
  const double cos_mount = std::cos(mount_angle_rad);
  const double sin_mount = std::sin(mount_angle_rad);
  const double cos_earth = std::cos(seen.earth_angle_rad);
  const double sin_earth = std::sin(seen.earth_angle_rad);
  const double cos_half_chord = std::clamp(
      (std::cos(seen.disc_rad) - cos_mount * cos_earth) / (sin_mount * sin_earth), -1.0, 1.0);
  return (sin_mount * cos_earth - cos_mount * cos_half_chord * sin_earth) / std::sin(seen.disc_rad);
}

}  // namespace

SpinAlignmentVector sun_angle_per_error(const SunSensor& slits, double sun_angle_rad) {
  SpinAlignmentVector larger = SpinAlignmentVector::Zero();
  const double tan_cant = std::tan(slits.slit_cant_rad);
  const double sin_sun = std::sin(sun_angle_rad);
  const double cos_sun = std::cos(sun_angle_rad);
  const double sin_lag = std::clamp(tan_cant * cos_sun / sin_sun, -1.0, 1.0);
  larger[SlitCantError] = -sin_sun * cos_sun * (1.0 + tan_cant * tan_cant) / tan_cant;
  larger[SlitSeparationError] = -sin_sun * sin_sun * std::sqrt(1.0 - sin_lag * sin_lag) / tan_cant;
  return larger;
}

ErrorsOfAlignment errors_of_alignment(const SpinConfig& config, const SeenByAxis& seen) {
  ErrorsOfAlignment errors = ErrorsOfAlignment::Zero();
  errors.row(SunAngleError) =
      sun_angle_per_error(config.sun_sensor, seen.sun_angle_rad).transpose();
  const double disc_per_km = -std::tan(seen.disc_rad) / horizon_axes(config.horizon).equatorial_km;
  if (config.north) {
    errors(NorthLimb, NorthMountAngleError) =
        disc_per_mount_angle(config.north->mount_angle_rad, seen);
  }
  if (config.south) {
    errors(SouthLimb, SouthMountAngleError) =
        disc_per_mount_angle(config.south->mount_angle_rad, seen);
  }
  errors(NorthLimb, Co2AltitudeError) = errors(SouthLimb, Co2AltitudeError) = disc_per_km;
  errors(NorthAzimuth, NorthAzimuthError) = errors(SouthAzimuth, SouthAzimuthError) = 1.0;
  return errors;
}

}  // namespace spindrift
