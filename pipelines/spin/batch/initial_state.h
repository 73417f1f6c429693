/// @file
/// Estimates initial phase, rate and drift of a pass for a given axis.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// Fits a parabola in time to the phase, which the counted revolutions unwrap.
/// @param axis_icrf Unit vector within some degrees of the true axis.
/// @return Unobservable when the axis predicts none of the edges.
Expected<SpinState> initial_state(const PassModel& model, std::span<const PassEdge> edges,
                                  const Eigen::Vector3d& axis_icrf);

}  // namespace spindrift
