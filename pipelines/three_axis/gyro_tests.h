/// @file
/// The tests of gyro samples, shared by gyro_watch.h (samples that arrive one by one) and
/// gyro_screening.h (all samples of a span).
///
/// The rate is nearly linear over a few samples, except where thrusters switch on or off. Even
/// there a sample lies between its neighbours or exceeds them by no more than the rate changes in
/// the adjacent interval. A spike exceeds them by more. The noise used is that of the samples, or
/// half a quantisation step if that is larger.

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

/// Tests a sample without its neighbours. It is saturated from 0.1 % below the range on, because a
/// clipped rate appears as the last value that the telemetry has below the range.
/// @param frozen Result for the run the sample belongs to; empty if it does not repeat.
std::optional<RejectedSample> rejected_alone(const GyroSample& sample, const GyroSensor& sensor,
                                             const std::optional<FailedTest>& frozen);

/// Holds how far a sample exceeds what its neighbours allow, on the axis where that is most.
struct GyroDeviation {
  double off_rad_s;
  double limit_rad_s;

  bool stands_out() const { return off_rad_s > limit_rad_s; }
};
RejectedSample outlier(const GyroSample& sample, const GyroDeviation& deviation);

/// Returns how far sample `i` exceeds both its neighbours beyond the change of rate in the adjacent
/// interval. If samples exist on both sides of the neighbours, the smaller change counts.
/// @param samples In time order; `i` is neither the first nor the last.
GyroDeviation deviation(std::span<const GyroSample> samples, std::size_t i, double noise_rad_s);

/// Returns how far the first or last sample of a span is off the line through its two neighbours,
/// beyond what is possible if their change of rate began only at the nearer one.
GyroDeviation deviation_at_end(const GyroSample& at, const GyroSample& next,
                               const GyroSample& next_but_one, double noise_rad_s);

/// Holds the offset of a sample from the line through the next two samples.
struct OffLine {
  Eigen::Vector3d off_rad_s;
  Eigen::Vector3d change_rad_s;  ///< Change of rate along the line from `next` to the sample.
  double spread;                 ///< Noise of `off_rad_s` as a multiple of the noise of one sample.
};
OffLine off_line(const GyroSample& at, const GyroSample& next, const GyroSample& next_but_one);

/// @param step_rad_s Quantisation step of the telemetry.
inline double noise_or_step_rad_s(double noise_rad_s, double step_rad_s) {
  return std::max(noise_rad_s, 0.5 * step_rad_s);
}

}  // namespace spindrift
