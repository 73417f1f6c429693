/// @file
/// Pure spin about an axis at rest, its rate drifting evenly.

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// Turns right-handed about the axis. The azimuth of slit 1 is counted about the axis from the
/// direction east of it (`tangent_basis`).
struct SpinMotion {
  Eigen::Vector3d axis_icrf;  ///< Unit length.
  double rate_rad_s;          ///< At the start; positive all the time.
  double rate_drift_rad_s2;
  double first_azimuth_rad;  ///< Of slit 1 at the start.

  /// Azimuth of slit 1, not wrapped.
  double azimuth_rad(double t_s) const {
    return first_azimuth_rad + (rate_rad_s + 0.5 * rate_drift_rad_s2 * t_s) * t_s;
  }
  double rate_at_rad_s(double t_s) const { return rate_rad_s + rate_drift_rad_s2 * t_s; }
};

}  // namespace spindrift
