/// @file
/// Finds a step of the spin rate as a changepoint in the times of the revolutions.

#pragma once

#include <optional>
#include <span>

#include "pipelines/spin/batch/changepoint.h"
#include "pipelines/spin/batch/pass_edges.h"

namespace spindrift {

/// Finds where two parabolas explain one channel's edge times, by counted revolution, significantly
/// better than one. It needs no axis and so finds steps after which no state fits, to one
/// revolution.
/// @param edges Edges in order of time.
/// @return The step, whose `t` is the time of the first edge after it; empty if there is none.
std::optional<Changepoint> find_rate_changepoint(std::span<const PassEdge> edges);

}  // namespace spindrift
