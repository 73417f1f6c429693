/// @file
/// Search of the whole sky for competing axes, independent of the fixes.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// Returns up to a few other axes that explain some hundreds of edges, spread over the pass, better
/// than `state` or nearly as well; best first.
std::vector<Eigen::Vector3d> competing_axes(const SpinState& state, const PassModel& model,
                                            std::span<const PassEdge> edges, BiasSet estimated);

}  // namespace spindrift
