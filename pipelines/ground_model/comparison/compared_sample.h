/// @file
/// What of flight and of the model is held against each other, channel by channel.

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
  std::string name;       ///< "gyro_x"; of a sensor as a whole, "gyro", it is whether it sends.
  std::string_view unit;  ///< Of its values; empty: it has none, and only has to come.
  double holding_s;       ///< Over which is judged whether flight has departed.
};

/// In the unit of the channel.
struct ComparedValue {
  double flight;
  double model;
  double sigma;  ///< One, of their difference by noise; above 0.

  double residual() const { return flight - model; }
  double normalised() const { return residual() / sigma; }
};

struct ComparedSample {
  std::size_t channel;  ///< Its place among those of the model.
  TaiTime t;
  bool came;  ///< false: the model sends, and flight does not.
  std::optional<ComparedValue> value = {};
};

/// @param step_s From sample to sample. @return ten seconds, and twenty samples at least: outliers
///        are no departure.
inline double holding_s(double step_s) {
  constexpr double kLeast_s = 10.0;
  constexpr double kSamples = 20.0;
  return std::max(kLeast_s, kSamples * step_s);
}

}  // namespace spindrift
