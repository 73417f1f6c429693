/// @file
/// Tests whether one attitude and one uniformly drifting rate explain the whole pass, and finds a
/// step of the rate in the times of the revolutions.

#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "pipelines/spin/batch/pass_information.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// Marks where one state before and one after explain the edges significantly better than one.
struct Changepoint {
  TaiTime t;               ///< Begin of the span of edges that contains the change.
  std::size_t first_edge;  ///< Index of the first edge after the change.
  double gain;             ///< Twice the gain of log likelihood.
};

/// @param state State that explains all edges best.
/// @return The clearest change that leaves edges as outliers, else the clearest; empty if none.
std::optional<Changepoint> find_changepoint(const PassModel& model, std::span<const PassEdge> edges,
                                            const SpinState& state);

/// Finds where two parabolas explain one channel's edge times, by counted revolution, significantly
/// better than one. It needs no axis and so finds steps after which no state fits, to one
/// revolution.
/// @param edges Edges in order of time.
/// @return The step, whose `t` is the time of the first edge after it; empty if there is none.
std::optional<Changepoint> find_rate_changepoint(std::span<const PassEdge> edges);

}  // namespace spindrift
