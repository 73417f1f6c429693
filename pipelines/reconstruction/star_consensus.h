/// @file
/// Star fixes that agree, by what the gyro turned between them.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/rate_track.h"

namespace spindrift {

struct StarConsensus {
  std::vector<StarObservation> accepted;
  std::int64_t gated = 0;
  /// No fix has most of its neighbours with it: all are accepted, as nobody knows which is wrong.
  bool contradict = false;
};

struct ConsensusNoise {
  double star_rad;
  Eigen::Vector3d bias_rad_s;
  Eigen::Matrix3d bias_covariance_rad2_s2;
};

/// A fix is accepted that agrees with at least half of the four before and the four behind it that
/// are accepted.
StarConsensus consensus_of(const RateTrack& rates, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise);

}  // namespace spindrift
