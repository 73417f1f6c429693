/// @file
/// The estimator `batch`: finds the likeliest state of the body for all edges of a pass, the sensor
/// biases that the edges show, and the Cramer-Rao bound of the axis.
///
/// It starts at every axis it is given and keeps the likeliest solution. Where two axes explain the
/// edges equally well the solution is AMBIGUOUS. A pass with a change of attitude or rate, which no
/// axis in the sky explains without one, is solved from the last change on. The mission file may
/// name the biases to estimate; otherwise significant biases are added one after the other.
///
/// The qualities are
///     OK         none of the following applies
///     CONVERGING as OK, but from too few revolutions (convergence.h)
///     AMBIGUOUS  another axis, which is named, fits as well
///     DOUBTFUL   the edges scatter more than their noise, many are outliers, most of them lie
///                before a change or fit no axis; a bias or coning is implausible, or the residuals
///                call for another bias; or the mission file is off by more than it states

#pragma once

#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// @param edges Edges in order of time.
/// @return Unobservable, saying what is missing, when edges or starts do not suffice; NoCoverage.
Expected<BatchSolution> solve_batch(const SpinConfig& config, const Orbit& orbit,
                                    std::span<const PassEdge> edges, const StartingAxes& starts);

}  // namespace spindrift
