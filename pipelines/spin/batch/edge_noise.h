/// @file
/// Observed noise of the edges about a state, separately for sun slits and infrared beams.

#pragma once

#include <span>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Estimates the noise from the median deviation of each channel's edges from their median, so that
/// neither outliers nor a bias affect it. The result is never below the stated noise.
PulseNoise noise_seen(const PassModel& model, std::span<const PassEdge> edges,
                      const SpinState& state);

}  // namespace spindrift
