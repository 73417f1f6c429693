/// @file
/// Offset of a channel's times that is constant over a pass: a consider parameter
/// (statistics/considered.h), since no edge of the pass shows it.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

inline constexpr int kChannelOffsets = static_cast<int>(kPulseChannels);

/// Covariance of the channels' offsets, s^2.
using OffsetPrior = Eigen::Matrix<double, kChannelOffsets, kChannelOffsets>;

/// Where the spin rate is commensurate with the grid of the times, each channel has an offset of
/// its own. Elsewhere the grid's error averages out, and this prior is too large.
inline OffsetPrior offset_prior_s2(const PulseNoise& noise) {
  const double sigma_s = grid_sigma_s(noise);
  return sigma_s * sigma_s * OffsetPrior::Identity();
}

}  // namespace spindrift
