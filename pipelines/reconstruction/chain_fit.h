/// @file
/// The likeliest state of a chain, by Ceres: cost grows linearly with its nodes.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/chain.h"

namespace spindrift {

/// How far off a sun vector still pulls.
enum class SunLoss {
  Far,   ///< Huber's: all do, for a start that may be far off.
  Near,  ///< As least squares to 4 sigmas, then ever less; beyond 8 not at all.
};

/// What is left of a sun vector's weight.
/// @param squares Of its residual, in sigmas.
double weight_of(double squares);
/// Where no more than that is left.
double squares_of(double weight);

struct ChainFit {
  ChainState state;
  int iterations;
};

/// @return Unobservable where no minimum is found.
Expected<ChainFit> fit(const Chain& chain, ChainState start, SunLoss loss);

}  // namespace spindrift
