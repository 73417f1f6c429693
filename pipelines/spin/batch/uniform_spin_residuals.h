/// @file
/// Residuals of the edges against the best uniform spin, for the search for nutation.

#pragma once

#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/nutation/uniform_spin_residual.h"

namespace spindrift {

/// Of edges within thirty sigmas, or thirty times what all scatter by, of where the state has them:
/// nutation puts them off by several.
std::vector<UniformSpinResidual> uniform_spin_residuals(const PassModel& model,
                                                        std::span<const PassEdge> edges,
                                                        const SpinState& state);

/// How many sigmas one standard deviation of them is, whatever their outliers; at least 1.
double scatter_of(std::span<const UniformSpinResidual> residuals);

}  // namespace spindrift
