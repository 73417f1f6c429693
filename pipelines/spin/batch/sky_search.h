/// @file
/// Search of the whole sky for competing axes, independent of the fixes.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"

namespace spindrift {

/// Other axes that explain some hundreds of the edges, spread over the pass, better than this state
/// or nearly as well; the best first, a few at most.
std::vector<Eigen::Vector3d> competing_axes(const SpinState& state, const PassModel& model,
                                            std::span<const PassEdge> edges, BiasSet estimated);

}  // namespace spindrift
