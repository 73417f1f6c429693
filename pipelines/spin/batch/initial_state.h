/// @file
/// Initial phase, rate and drift of a pass about a given axis.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// The turns have been counted: the unwrapped phase is a parabola in time.
/// @param axis_icrf Unit; within some degrees.
/// @return Unobservable where no edge is one that the axis has.
Expected<SpinState> initial_state(const PassModel& model, std::span<const PassEdge> edges,
                                  const Eigen::Vector3d& axis_icrf);

}  // namespace spindrift
