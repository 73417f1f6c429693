/// @file
/// Assesses the quality of a solution of the estimator `batch`, with reasons.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/spin/batch/after_changepoint.h"
#include "pipelines/spin/batch/batch_solution.h"

namespace spindrift {

/// Holds what assess() needs and a BatchSolution does not contain.
struct BatchDoubts {
  std::optional<Eigen::Vector3d> alternate_axis_icrf;  ///< Axis that explains the edges as well.
  double revolutions;  ///< Number of revolutions that the edges span.
  std::optional<LeftOut> left_out;
  BiasSet estimated;
  BiasSet at_bound;
  bool coning_by_edges;              ///< True when the edges, not the mission file, ask for coning.
  std::optional<SensorBias> wanted;  ///< Bias that the residuals still call for.
  std::optional<Reason> model_off = {};  ///< Error of the mission file beyond what it states.
};

/// Returns whether left-out edges and outliers exceed twice the edges that the solution rests on.
bool rests_on_few(const BatchSolution& solution, const LeftOut& left_out);

/// Grades a solution by the quality rules in batch_estimator.h.
Assessment assess(const BatchSolution& solution, const BatchDoubts& doubts);

}  // namespace spindrift
