/// @file
/// Finds the maximum-likelihood state of a pass with Ceres, weighting edges by Tukey's biweight.

#pragma once

#include <cstddef>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

struct BatchFit {
  SpinState state;
  BiasSet at_bound;  ///< Biases that reached the bound of their prior.
  int iterations;
};

/// Number of edges, spread over the pass, that is enough for a coarse fit.
inline constexpr std::size_t kCoarseEdges = 6000;

/// Fits at most some thousands of edges with a Huber loss, to see which starts share a solution.
SpinState coarse_fit(const PassModel& model, std::span<const PassEdge> edges,
                     const SpinState& start, BiasSet estimated);

/// @param start State accurate to a few degrees, so that edges can be told from outliers.
/// @param estimated Biases to estimate, each with its prior about zero; the others keep the values
///        of the start.
/// @return Unobservable when Ceres finds no minimum.
Expected<BatchFit> fit(const PassModel& model, std::span<const PassEdge> edges,
                       const SpinState& start, BiasSet estimated);

}  // namespace spindrift
