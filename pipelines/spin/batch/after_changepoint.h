/// @file
/// Solves a pass from its last change of attitude or rate on and describes the edges left out.

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/batch/multi_start.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Describes the edges before the last change, which the solution does not use.
struct LeftOut {
  TaiTime until;
  std::int64_t edges;
  bool fit_one_attitude;  ///< True also when the edges are too few to tell.
};

/// Holds the solution of the edges from the last change on.
struct Solved {
  PassModel model;
  std::span<const PassEdge> edges;
  Best of;
  std::optional<LeftOut> left_out;
};

/// @return Unobservable when the edges are too few or the state keeps changing; NoCoverage.
Expected<Solved> solve_after_changepoint(const SpinConfig& config, const Orbit& orbit,
                                         std::span<const PassEdge> edges,
                                         const StartingAxes& starts, BiasSet estimated);

}  // namespace spindrift
