/// @file
/// The estimator `batch`: the state of the body that makes all edges of a pass the likeliest, with
/// the biases of the sensors that they show, and the bound that no estimator can beat beside it.
///
/// It begins at every axis it is given and keeps the likeliest. Where two axes explain the edges
/// alike it is AMBIGUOUS. A pass in which the attitude or the rate has changed, which no axis in
/// the sky explains without, is solved from the last change on. Biases are those that the mission
/// asks for; where it does not say, the edges decide, one bias after the other, as long as one
/// explains the residuals beyond doubt.
///
/// Its quality is
///     OK         all is well
///     CONVERGING likewise, but of too few revolutions (convergence.h)
///     AMBIGUOUS  another axis, named, fits as well
///     DOUBTFUL   the edges scatter more than their noise, many are outliers, most of them lie
///                before a change, or fit no axis; a bias or coning is not to be believed, or the
///                residuals still ask for one

#pragma once

#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/batch/starting_axes.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// @param edges In order of time.
/// @return Unobservable where edges or starts do not suffice, with what is missing; NoCoverage.
Expected<BatchSolution> solve_batch(const SpinConfig& config, const Orbit& orbit,
                                    std::span<const PassEdge> edges, const StartingAxes& starts);

}  // namespace spindrift
