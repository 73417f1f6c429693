/// @file
/// The tests of gyro samples, for those that come one by one (gyro_watch.h) and for all of a span
/// (gyro_screening.h).
///
/// The rate is nearly linear over a few samples, but for the instants at which thrusters begin and
/// end: there too a sample lies between its neighbours, or beyond them by no more than the rate
/// changes beside them. A spike lies beyond them by more. The noise is that of the samples, and
/// half a step of the telemetry where that is more.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

/// Whatever its neighbours are. Saturated within a thousandth of the range or beyond it: a clipped
/// rate is told by the last number that the telemetry has below the range.
/// @param frozen Of the row in which it stands; empty: it does not repeat.
std::optional<RejectedSample> rejected_alone(const GyroSample& sample, const GyroSensor& sensor,
                                             const std::optional<FailedTest>& frozen);

/// How far a sample is from where its neighbours allow it, about the axis where that is most.
struct GyroDeviation {
  double off_rad_s;
  double limit_rad_s;

  bool stands_out() const { return off_rad_s > limit_rad_s; }
};
RejectedSample outlier(const GyroSample& sample, const GyroDeviation& deviation);

/// Of the sample `i` beyond both its neighbours, by more than the rate changes beside them: where
/// there is a sample more on either side, by the less of the two changes.
/// @param samples In order of time; `i` is not at an end.
GyroDeviation deviation(std::span<const GyroSample> samples, std::size_t i, double noise_rad_s);

/// Of the first, or the last, sample off the line through the two next to it, beyond where their
/// change just began.
GyroDeviation deviation_at_end(const GyroSample& at, const GyroSample& next,
                               const GyroSample& next_but_one, double noise_rad_s);

/// A sample off the line through the two next to it.
struct OffLine {
  Eigen::Vector3d off_rad_s;
  Eigen::Vector3d change_rad_s;  ///< What the line makes of the rate from the next sample to it.
  double spread;                 ///< Of noise in `off_rad_s`: so many times that of a sample.
};
OffLine off_line(const GyroSample& at, const GyroSample& next, const GyroSample& next_but_one);

/// @param step_rad_s Of the telemetry.
inline double noise_or_step_rad_s(double noise_rad_s, double step_rad_s) {
  return std::max(noise_rad_s, 0.5 * step_rad_s);
}

}  // namespace spindrift
