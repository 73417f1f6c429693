/// @file
/// The solution from the last changepoint of attitude or rate on, and what is left out before it.

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/batch/multi_start.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/batch/starting_axes.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// The edges before a change.
struct LeftOut {
  TaiTime until;
  std::int64_t edges;
  bool fit_one_attitude;  ///< Or are too few to tell.
};

/// All that is found out of the edges from the last change on.
struct Solved {
  PassModel model;
  std::span<const PassEdge> edges;
  Best of;
  std::optional<LeftOut> left_out;
};

/// @return Unobservable where edges do not suffice, or change all the time; NoCoverage.
Expected<Solved> solve_after_changepoint(const SpinConfig& config, const Orbit& orbit,
                                         std::span<const PassEdge> edges,
                                         const StartingAxes& starts, BiasSet estimated);

}  // namespace spindrift
