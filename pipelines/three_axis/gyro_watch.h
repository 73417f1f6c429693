/// @file
/// Judges gyro samples as they arrive and tracks how the rate changes between them.
/// gyro_screening.h judges all samples of a span together.

#pragma once

#include <optional>

#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/frozen_samples.h"
#include "pipelines/three_axis/gyro_tests.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/rate_wander.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

class GyroWatch {
 public:
  explicit GyroWatch(const GyroSensor& sensor)
      : sensor_{sensor}, noise_rad_s_{sensor.noise_rad_s}, wander_{sensor.noise_rad_s} {}

  /// Tests a sample by itself; must be called once for each sample.
  /// @param sample Later than the previous one.
  /// @return Reason why the sample is invalid whatever follows it; empty if it may be valid.
  std::optional<RejectedSample> judge(const GyroSample& sample);

  /// Returns how far a sample is off the line through the previous two; empty if there are fewer
  /// than two. A sample that stands out is a suspect until the next one confirms or refutes it.
  std::optional<GyroDeviation> deviation_from_line(const GyroSample& sample) const;
  /// Returns how far a suspect is off its neighbours on both sides.
  GyroDeviation deviation_from_both(const GyroSample& suspect, const GyroSample& next) const;

  /// Adopts the sample as a valid measurement.
  void accept(const GyroSample& sample);

  /// Returns the last valid measurement; empty if there is none yet.
  const std::optional<GyroSample>& last() const { return last_; }

  /// Returns why the most recent samples are invalid; empty if the last one was valid or none came.
  std::optional<Rejection> out_because() const { return out_because_; }
  /// Returns the time of the first of these invalid samples.
  TaiTime out_since() const { return out_since_; }

  /// Returns the noise of the samples, at least the stated one.
  double noise_rad_s() const { return noise_rad_s_; }

  double wander_rad2_s3() const { return wander_.rad2_s3(); }

  /// Returns whether samples are missing in an interval between two consecutive ones.
  bool is_gap(double interval_s) const;

 private:
  void note_interval(double interval_s);
  void note_noise(const GyroSample& sample);
  double scatter_rad_s() const;

  GyroSensor sensor_;
  FrozenSamples frozen_ = FrozenSamples::of_gyro();
  std::optional<GyroSample> before_last_;
  std::optional<GyroSample> last_;
  std::optional<Rejection> out_because_;
  TaiTime out_since_{};
  double intervals_ = 0.0;
  double usual_interval_s_ = 0.0;
  double noise_rad_s_;  ///< Estimated noise, at least the stated one.
  RateWander wander_;
};

}  // namespace spindrift
