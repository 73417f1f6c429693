/// @file
/// The chain of all samples, solved: a coarse solution of some of them first, in which sun vectors
/// far off still pull and star fixes that contradict it are found.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/chain.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/star_consensus.h"

namespace spindrift {

struct SolvedChain {
  Chain chain;
  ChainState state;
  int iterations;
};

struct ChainSolution {
  SolvedChain solved;
  StarConsensus stars;
  // So many times the stated noise is that of the chain, at least 1.
  double louder_sun;
  double louder_star;
};

/// Of the sun vectors, by the median of a coarse solution; 1 where there is none.
double louder_sun(const ReconstructionRequest& request, const Observations& all);

/// @return Unobservable where no minimum is found.
Expected<ChainSolution> solution_of(const ReconstructionRequest& request, const Observations& all);

}  // namespace spindrift
