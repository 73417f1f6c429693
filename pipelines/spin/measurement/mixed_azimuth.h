/// @file
/// Sun angle and dihedral from the one combination of them that sun slit 2 gives alone: the azimuth
/// of the Earth behind it (case 7 of pipelines/spin/fix/README.md).

#pragma once

#include <optional>
#include <vector>

#include "pipelines/spin/types/config.h"

namespace spindrift {

/// mu = lambda - psi_12 in (-pi, pi]; empty where slit 2 does not see the Sun.
std::optional<double> predict_mixed_azimuth_rad(const SunSensor& sensor, double sun_angle_rad,
                                                double dihedral_rad);

struct MixedAzimuth {
  SunSensor sensor;
  double azimuth_rad;  ///< mu = lambda - psi_12, the crossing's middle behind sun2.
  double earth_angle_rad;
  double sun_earth_rad;
};

/// psi_12 - psi0, which fixes theta_s = atan2(tan I, sin(lag)) and lambda = mu + psi0 + lag; and
/// its derivatives.
struct SlitLag {
  double lag_rad;  ///< (-pi/2, pi/2)
  double to_earth_angle;
  double to_azimuth;
};

struct SlitLags {
  std::vector<SlitLag> lags;  ///< The least first.
  /// How near two roots are to merging, as a cosine: the depth of the curve between them, or its
  /// least distance from zero where a pair of roots is just missing.
  double nearest_miss;
};

/// All lags that agree with the angle between Sun and Earth.
SlitLags slit_lags(const MixedAzimuth& mixed);

}  // namespace spindrift
