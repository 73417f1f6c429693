/// @file
/// Finds the maximum-likelihood state of a chain with Ceres, at a cost linear in the nodes.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/chain.h"

namespace spindrift {

/// The robust loss of sun vectors.
enum class SunLoss {
  Far,   ///< Huber loss: every vector pulls, for a start that may be far off.
  Near,  ///< Least squares up to 4 sigmas, falling to no pull at 8 sigmas.
};

/// Returns the weight that `SunLoss::Near` leaves to a sun vector.
/// @param squares Squared residual, in sigmas squared.
double weight_of(double squares);
double weight_of(const ChainSun& sun, const Chain& chain, const ChainState& state);
/// The inverse of `weight_of`.
double squares_of(double weight);

struct ChainFit {
  ChainState state;
  int iterations;
};

/// @return Unobservable if the iteration does not converge.
Expected<ChainFit> fit(const Chain& chain, ChainState start, SunLoss loss);

}  // namespace spindrift
