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

/// One that disagrees with most of its neighbours.
struct GatedStar {
  StarObservation of;
  double nis;  ///< Of the difference from the one that is in the middle of them, three freedoms.
};

struct StarConsensus {
  std::vector<StarObservation> accepted;
  std::vector<GatedStar> gated = {};
  /// No fix has most of its neighbours with it: all are accepted, as nobody knows which is wrong.
  bool contradict = false;
};

struct ConsensusNoise {
  double star_rad;
  Eigen::Vector3d bias_rad_s;
  Eigen::Matrix3d bias_covariance_rad2_s2;
};

/// What those said that were gated: how far off they are nobody has found.
void add_gated(const Observations& all, const StarConsensus& stars, std::vector<Observation>& said);

/// A fix is accepted that agrees with at least half of the four before and the four behind it that
/// are accepted.
StarConsensus consensus_of(const RateTrack& rates, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise);

}  // namespace spindrift
