/// @file
/// Observed noise of the edges about a state, of slits and of beams separately.

#pragma once

#include <span>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// By the median deviation of each channel's edges from their median: neither outliers, however
/// many the noise makes, nor a bias count. No less than stated.
PulseNoise noise_seen(const PassModel& model, std::span<const PassEdge> edges,
                      const SpinState& state);

}  // namespace spindrift
