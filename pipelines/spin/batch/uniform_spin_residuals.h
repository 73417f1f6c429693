/// @file
/// Residuals of the edges against the best uniform spin, as input of the nutation search.

#pragma once

#include <span>
#include <vector>

#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/nutation/uniform_spin_residual.h"

namespace spindrift {

/// Returns residuals of the edges within 30 sigmas of their prediction, or within 30 times the
/// observed scatter, because nutation moves edges by several sigmas.
std::vector<UniformSpinResidual> uniform_spin_residuals(const PassModel& model,
                                                        std::span<const PassEdge> edges,
                                                        const SpinState& state);

/// Returns the robust standard deviation of the residuals in sigmas, at least 1.
double scatter_of(std::span<const UniformSpinResidual> residuals);

}  // namespace spindrift
