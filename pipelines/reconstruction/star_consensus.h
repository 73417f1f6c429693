/// @file
/// Selects star fixes that agree with each other, given the gyro turns between them.

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
  /// Observation of each fix, used or not, in time order. Its residual is relative to the neighbour
  /// with the median difference. There is none if a fix has no neighbours.
  std::vector<Observation> said = {};
  /// True if no fix agrees with most neighbours; all are then accepted, as any may be wrong.
  bool contradict = false;

  /// Returns the observations of fixes that disagree with most of their neighbours.
  std::vector<Observation> gated() const;
  void add(const std::vector<Observation>& more);
};

struct ConsensusNoise {
  double star_rad;
  Eigen::Vector3d bias_rad_s;
  SharedCovariance shared;  ///< Covariance of what is left of the shared errors.
};

/// Returns the derivative by the shared errors of the difference of the later fix from its
/// prediction by the earlier one and the gyro, in body axes at the later.
PerShared difference_per_shared(const RateTrack& rates, const StarObservation& earlier,
                                const StarObservation& later, const Turn& turn);

/// Accepts a fix that agrees with at least half of its accepted neighbours, four on each side.
StarConsensus consensus_of(const Observations& all, std::span<const StarObservation> stars,
                           const ConsensusNoise& noise);

}  // namespace spindrift
