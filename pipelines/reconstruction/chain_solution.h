/// @file
/// Solves the chain of all samples. A coarse solution of a subset comes first; in it distant sun
/// vectors still pull, and it identifies the star fixes that contradict it.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/chain.h"
#include "pipelines/reconstruction/chain_covariance.h"
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

struct CoarseFindings {
  double louder_sun = 1.0;  ///< Sun vector noise over the stated one, by the median.
  FittedFile file = {};
};

/// Returns what a coarse solution finds; nothing if there is none.
CoarseFindings coarse_findings(const ReconstructionRequest& request, const Observations& all);

/// @return Unobservable if the iteration does not converge.
Expected<ChainSolution> solution_of(const ReconstructionRequest& request, const Observations& all);

}  // namespace spindrift
