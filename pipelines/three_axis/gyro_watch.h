/// @file
/// Which gyro samples are measurements, and how the rate changes between them.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

class GyroWatch {
 public:
  /// A gyro that gives the same numbers so often in a row is frozen: noise that is not below the
  /// step of the telemetry does it once in a thousand million times.
  static constexpr int kFrozenInARow = 10;

  explicit GyroWatch(const GyroSensor& sensor) : sensor_{sensor} {}

  /// @param sample Later than the one before.
  /// @return Why it is no measurement; empty: it is one.
  std::optional<SampleRejection> judge(const GyroSample& sample);

  /// The last measurement; empty: none yet.
  const std::optional<GyroSample>& last() const { return last_; }

  /// Why the samples behind it are none; empty: there are no samples.
  std::optional<SampleRejection> out_because() const { return out_because_; }

  /// Spectral density of the rate's change, of each axis, rad^2/s^3, as it changes from second to
  /// second beyond the noise: by so much the rate wanders where nobody measures it.
  double wander_rad2_s3() const;

  /// Whether samples are missing in an interval between two.
  bool is_gap(double interval_s) const;

 private:
  void note(const GyroSample& sample);

  GyroSensor sensor_;
  std::optional<GyroSample> last_;
  std::optional<SampleRejection> out_because_;
  Eigen::Vector3d repeated_rad_s_ = Eigen::Vector3d::Zero();
  int repeats_ = 0;
  double intervals_ = 0.0;
  double usual_interval_s_ = 0.0;
  GyroSample a_second_ago_;
  double wander_rad2_s3_ = 0.0;  ///< Less the noise; may be below zero by chance.
};

}  // namespace spindrift
