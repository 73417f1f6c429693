/// @file
/// A step of the spin rate, found as a changepoint in the times of the turns.

#pragma once

#include <optional>
#include <span>

#include "pipelines/spin/batch/changepoint.h"
#include "pipelines/spin/batch/pass_edges.h"

namespace spindrift {

/// Where two parabolas, one before and one after, explain the times of a channel's edges by the
/// turns counted beyond doubt better than one. Needs no axis, and so finds steps after which no
/// state fits; to the turn.
/// @param edges In order of time.
/// @return Its `t` is that of the first edge after it; empty: there is none.
std::optional<Changepoint> find_rate_changepoint(std::span<const PassEdge> edges);

}  // namespace spindrift
