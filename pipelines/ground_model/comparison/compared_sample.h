/// @file
/// Samples of flight and model that are compared channel by channel.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/time/tai_time.h"

namespace spindrift {

struct ComparedChannel {
  std::string name;       ///< Name, e.g. "gyro_x". Channel "gyro" tells whether the sensor sends.
  std::string_view unit;  ///< Unit of the values; empty for a channel that only has to send.
  double holding_s;       ///< Time over which a departure of flight is judged.
};

/// Values of flight and model in the unit of the channel.
struct ComparedValue {
  double flight;
  double model;
  double sigma;  ///< Standard deviation of their difference due to noise; above 0.

  double residual() const { return flight - model; }
  double normalised() const { return residual() / sigma; }
};

struct ComparedSample {
  std::size_t channel;  ///< Index among the model's channels.
  TaiTime t;
  bool came;  ///< False where the model sends and flight does not.
  std::optional<ComparedValue> value = {};
};

/// Returns the time over which a departure is judged: ten seconds and twenty samples at least, so
/// that single outliers are no departure.
/// @param step_s Time between samples.
inline double holding_s(double step_s) {
  constexpr double kLeast_s = 10.0;
  constexpr double kSamples = 20.0;
  return std::max(kLeast_s, kSamples * step_s);
}

}  // namespace spindrift
