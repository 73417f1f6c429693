/// @file
/// A gyro sample that is none of the body's rates: its neighbours do not go there.
///
/// The rate is nearly linear over a few samples, but for the instants at which thrusters begin and
/// end: there too a sample lies between its neighbours, or beyond them by no more than the rate
/// changes beside them. A spike lies beyond them by more. The noise is that of the samples, and
/// half a step of the telemetry where that is more.

#pragma once

#include <Eigen/Core>

#include "pipelines/three_axis/samples.h"

namespace spindrift {

/// By how much the rate would change from `from` to `t`, about each axis, as it does between two
/// samples beside. Not below zero.
Eigen::Vector3d change_rad_s(const GyroSample& a, const GyroSample& b, TaiTime from, TaiTime t);

/// How far a sample is from where its neighbours allow it, about the axis where that is most.
struct GyroDeviation {
  double off_rad_s;
  double limit_rad_s;

  bool stands_out() const { return off_rad_s > limit_rad_s; }
};

/// Beyond both neighbours.
/// @param change_rad_s What the rate may have gone beyond them by.
GyroDeviation deviation(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& at_rad_s,
                        const Eigen::Vector3d& behind_rad_s, const Eigen::Vector3d& change_rad_s,
                        double noise_rad_s);

/// Of the first, or the last, sample off the line through the two next to it, beyond where their
/// change just began.
GyroDeviation deviation_at_end(const GyroSample& at, const GyroSample& next,
                               const GyroSample& next_but_one, double noise_rad_s);

}  // namespace spindrift
