/// @file
/// One turn of the body as its sensors should see it, for a known axis and spin rate.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

/// Channels whose edges come so near to each other that they spoil each other.
struct ColocatedChannels {
  PulseChannel one;
  PulseChannel other;
};

struct ExpectedRevolution {
  /// Edges without noise, to the nearest nanosecond; those that meet are rejected as
  /// `Interference`.
  Revolution revolution;
  /// Prediction of each edge that exists.
  std::array<std::optional<PredictedEdge>, kPulseChannels> predicted;
  std::vector<ColocatedChannels> meeting;
};

/// Returns the turn that begins with slit 1 at the Sun at the time of the sky; chords begin in it.
/// @param R_spin_icrf Rotation to a frame `spin` (edge_prediction.h).
/// @param sun_hidden Whether the Earth hides the Sun, so that there are no sun edges.
ExpectedRevolution expected_revolution(const SpinConfig& config, const Sky& sky,
                                       const Eigen::Matrix3d& R_spin_icrf, double rate_rad_s,
                                       bool sun_hidden);

}  // namespace spindrift
