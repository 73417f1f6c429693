/// @file
/// Which gyro samples tell a rate: not those at the end of the range, nor those that repeat.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

struct ScreenedGyro {
  std::vector<GyroSample> usable;
  std::int64_t saturated = 0;
  /// Behind the first of a row of samples whose rates, all three or one, are the same, longer than
  /// noise makes by chance on the grid of the telemetry.
  std::int64_t frozen = 0;
  /// How many times the stated noise they scatter by about the lines through their neighbours, by
  /// the median; empty where there are too few.
  std::optional<double> noise;
};

/// @param samples In order of time, each once.
ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor);

}  // namespace spindrift
