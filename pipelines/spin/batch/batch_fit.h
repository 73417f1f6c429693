/// @file
/// The maximum-likelihood state of a pass: Ceres over all its edges, each with Tukey's biweight.

#pragma once

#include <cstddef>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

struct BatchFit {
  SpinState state;
  BiasSet at_bound;  ///< Biases that ran to what no sensor exceeds.
  int iterations;
};

/// So many edges, spread over the pass, tell roughly what all do.
inline constexpr std::size_t kCoarseEdges = 6000;

/// Where a start leads by some thousands of edges, robustly: which of several starts are one.
SpinState coarse_fit(const PassModel& model, std::span<const PassEdge> edges,
                     const SpinState& start, BiasSet estimated);

/// @param start Near enough that edges are told from outliers within a few degrees.
/// @param estimated The biases that are unknown, each about zero by its prior; the others stay as
///        they are at the start.
/// @return Unobservable where no minimum is found.
Expected<BatchFit> fit(const PassModel& model, std::span<const PassEdge> edges,
                       const SpinState& start, BiasSet estimated);

}  // namespace spindrift
