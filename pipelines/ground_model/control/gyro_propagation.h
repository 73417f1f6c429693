/// @file
/// How a computer on board carries an attitude on by its gyro. What the ground makes of telemetry
/// is always composed (mekf.h, rate_track.h); this is for a spacecraft that flies the other.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/three_axis/mekf.h"

namespace spindrift {

enum class GyroPropagation {
  /// The turn of the span by the series of Magnus: exact about an axis that stays.
  Composition,
  /// Runge and Kutta's fourth order by the rates at both ends and their mean for the middle (seed
  /// 004, eq. 5 to 10). Of a turn by x rad a step about an axis that stays it loses x^5 / 1920 rad:
  /// 3e-9 where x is a tenth, 3e-14 where it is a hundredth.
  RungeKutta,
};

/// Both take the rate for linear between the samples. Where it is not, both are off by the same,
/// dt^3 / 12 of the second derivative of the rate, mostly more than what Runge and Kutta lose.
Eigen::Quaterniond propagated(GyroPropagation by, const Eigen::Quaterniond& q_icrf_body,
                              const RateSpan& span);

}  // namespace spindrift
