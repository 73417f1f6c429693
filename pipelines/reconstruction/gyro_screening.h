/// @file
/// Which gyro samples tell a rate: not those at the end of the range, those that repeat, nor
/// those off from their neighbours.

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
  std::int64_t frozen = 0;  ///< Behind the first of a row that repeats (frozen_samples.h).
  /// Off from their neighbours (gyro_outlier.h), by the noise that the samples have.
  std::int64_t outliers = 0;
  bool first_is_outlier = false;
  /// How many times the stated noise they scatter by about the lines through their neighbours, by
  /// the median; empty where there are too few.
  std::optional<double> noise;
};

/// @param samples In order of time, each once.
ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor);

}  // namespace spindrift
