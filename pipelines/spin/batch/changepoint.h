/// @file
/// Changepoints: whether one attitude and one uniformly drifting rate explain the whole pass.

#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// Where two states, one before and one after, explain the edges beyond doubt better than one.
struct Changepoint {
  TaiTime t;               ///< The span in which it lies begins here.
  std::size_t first_edge;  ///< Of those after it.
  double gain;             ///< Of log likelihood, times two.
};

/// @param state The one that explains them best.
/// @return The last change that leaves edges as outliers, or else the clearest; empty: none.
std::optional<Changepoint> find_changepoint(const PassModel& model, std::span<const PassEdge> edges,
                                            const SpinState& state);

}  // namespace spindrift
