/// @file
/// Which gyro samples are measurements, as they come, and how the rate changes between them. All of
/// a span together: gyro_screening.h.

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

  /// Once for each sample.
  /// @param sample Later than the one before.
  /// @return Why it is no measurement whatever comes; empty: it may be one.
  std::optional<RejectedSample> judge(const GyroSample& sample);

  /// How far it is off the line through the two before it; empty: there are none. One that stands
  /// out is suspect: the next one must tell what it is.
  std::optional<GyroDeviation> deviation_from_line(const GyroSample& sample) const;
  /// How far such a one is off from its neighbours.
  GyroDeviation deviation_from_both(const GyroSample& suspect, const GyroSample& next) const;

  /// It is a measurement.
  void accept(const GyroSample& sample);

  /// The last measurement; empty: none yet.
  const std::optional<GyroSample>& last() const { return last_; }

  /// Why the samples behind it are none; empty: there are no samples.
  std::optional<Rejection> out_because() const { return out_because_; }
  /// The first of those.
  TaiTime out_since() const { return out_since_; }

  double wander_rad2_s3() const { return wander_.rad2_s3(); }

  /// Whether samples are missing in an interval between two.
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
  double noise_rad_s_;  ///< That of the samples, where it is more than stated.
  RateWander wander_;
};

}  // namespace spindrift
