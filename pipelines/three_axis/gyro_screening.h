/// @file
/// Screens the gyro samples of a whole span: each sample is tested against both neighbours, with
/// the noise and quantisation step of all. For samples one by one see gyro_watch.h.

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
  /// Rejected samples in time order. Of a run of repeats, all but the first are rejected.
  std::vector<RejectedSample> left_out;
  bool first_is_outlier = false;
  /// Median scatter about lines through neighbours over the stated noise; empty if too few samples.
  std::optional<double> noise;
};

/// @param samples In time order, without duplicates.
ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor);

}  // namespace spindrift
