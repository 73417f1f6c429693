/// @file
/// Solves the chain of all samples. A coarse solution of a subset comes first; in it distant sun
/// vectors still pull, and it identifies the star fixes that contradict it.

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
  // The noise of the chain as a multiple of the stated noise, at least 1.
  double louder_sun;
  double louder_star;
};

/// Returns the sun vector noise over the stated one, by the median of a coarse solution; else 1.
double louder_sun(const ReconstructionRequest& request, const Observations& all);

/// @return Unobservable if the iteration does not converge.
Expected<ChainSolution> solution_of(const ReconstructionRequest& request, const Observations& all);

}  // namespace spindrift
