/// @file
/// Propagation of an attitude by the gyro in an on-board computer. The ground always composes
/// rotations (mekf.h, rate_track.h); Runge-Kutta is for a spacecraft whose computer uses it.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/three_axis/mekf.h"

namespace spindrift {

enum class GyroPropagation {
  /// Composes the turn of the span by the Magnus series: exact about a fixed axis.
  Composition,
  /// Integrates by fourth-order Runge-Kutta with the rates at both ends and their mean for the
  /// middle (seed 004, eq. 5 to 10). For a turn by x rad per step about a fixed axis its error is
  /// x^5 / 1920 rad: 3e-9 where x is a tenth, 3e-14 where it is a hundredth.
  RungeKutta,
};

/// Propagates the attitude over a span. Both methods take the rate as linear between the samples.
/// Where it is not, both have the same error, dt^3 / 12 of the second derivative of the rate, which
/// mostly exceeds the error of Runge-Kutta.
Eigen::Quaterniond propagated(GyroPropagation by, const Eigen::Quaterniond& q_icrf_body,
                              const RateSpan& span);

}  // namespace spindrift
