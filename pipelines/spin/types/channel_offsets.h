/// @file
/// What the times of a channel are off by all over a pass: a consider parameter
/// (statistics/considered.h), as no edge of the pass shows it.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

inline constexpr int kChannelOffsets = static_cast<int>(kPulseChannels);

/// Covariance by channel, s^2.
using OffsetPrior = Eigen::Matrix<double, kChannelOffsets, kChannelOffsets>;

/// Where the spin rate is commensurate with the grid of the times each channel
/// has an offset of its own. Where it is not, the grid's error averages out, and this is too much.
inline OffsetPrior offset_prior_s2(const PulseNoise& noise) {
  const double sigma_s = grid_sigma_s(noise);
  return sigma_s * sigma_s * OffsetPrior::Identity();
}

}  // namespace spindrift
