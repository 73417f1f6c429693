/// @file
/// Which gyro samples of a whole span tell a rate, by both sides of each and by what all of them
/// show of their noise and of the step of the telemetry. As they come: gyro_watch.h.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

struct ScreenedGyro {
  std::vector<GyroSample> usable;
  /// Of a row that repeats all but the first. In order of time.
  std::vector<RejectedSample> left_out;
  bool first_is_outlier = false;
  /// How many times the stated noise they scatter by about the lines through their neighbours, by
  /// the median; empty where there are too few.
  std::optional<double> noise;
};

/// @param samples In order of time, each once.
ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor);

}  // namespace spindrift
