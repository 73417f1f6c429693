/// @file
/// Star fixes that agree, by what the gyro turned between them.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipelines/observation/observation.h"
#include "pipelines/reconstruction/observations.h"

namespace spindrift {

struct StarConsensus {
  std::vector<StarObservation> accepted;
  /// Of each fix, used or not, off the neighbour that is in the middle of them. Nothing is expected
  /// of one without neighbours, nor where they contradict each other. In order of time.
  std::vector<Observation> said = {};
  /// No fix has most of its neighbours with it: all are accepted, as nobody knows which is wrong.
  bool contradict = false;

  /// What those said that disagree with most of their neighbours.
  std::vector<Observation> gated() const;
  void add(const std::vector<Observation>& more);
};

struct ConsensusNoise {
  double star_rad;
  Eigen::Vector3d bias_rad_s;
  Eigen::Matrix3d bias_covariance_rad2_s2;
};

/// A fix is accepted that agrees with at least half of the four before and the four behind it that
/// are accepted.
StarConsensus consensus_of(const Observations& all, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise);

}  // namespace spindrift
