/// @file
/// Solves sun angle and dihedral from their combination that slit 2 alone gives: the azimuth of the
/// Earth behind it (case 7 of pipelines/spin/fix/README.md).

#pragma once

#include <optional>
#include <vector>

#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Returns mu = lambda - psi_12 in (-pi, pi]; empty where slit 2 does not see the Sun.
std::optional<double> predict_mixed_azimuth_rad(const SunSensor& sensor, double sun_angle_rad,
                                                double dihedral_rad);

struct MixedAzimuth {
  SunSensor sensor;
  double azimuth_rad;  ///< Azimuth mu = lambda - psi_12 of the crossing's middle behind sun2.
  double earth_angle_rad;
  double sun_earth_rad;
};

/// Holds the lag psi_12 - psi0, which fixes theta_s = atan2(tan I, sin(lag)) and lambda = mu + psi0
/// + lag, and its derivatives.
struct SlitLag {
  double lag_rad;  ///< Lag in (-pi/2, pi/2).
  double to_earth_angle;
  double to_azimuth;
};

struct SlitLags {
  std::vector<SlitLag> lags;  ///< Lags in ascending order.
  /// Distance of two roots from merging, as a cosine: the depth of the curve between them, or its
  /// least distance from zero where a pair of roots is just missing.
  double nearest_miss;
};

/// Returns all lags that agree with the angle between Sun and Earth.
SlitLags slit_lags(const MixedAzimuth& mixed);

}  // namespace spindrift
