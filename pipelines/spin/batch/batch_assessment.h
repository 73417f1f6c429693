/// @file
/// Quality and reasons of a solution of the estimator `batch`.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/spin/batch/after_changepoint.h"
#include "pipelines/spin/batch/batch_solution.h"

namespace spindrift {

/// What a solution does not say of itself.
struct BatchDoubts {
  std::optional<Eigen::Vector3d> alternate_axis_icrf;  ///< Fits as well.
  double revolutions;                                  ///< That the edges are of.
  std::optional<LeftOut> left_out;
  BiasSet estimated;
  BiasSet at_bound;
  bool coning_by_edges;              ///< Nobody has asked for it.
  std::optional<SensorBias> wanted;  ///< What the residuals still ask for.
};

/// Most of the pass contradicts it, two edges for one, whatever may have happened in between.
bool rests_on_few(const BatchSolution& solution, const LeftOut& left_out);

/// As batch_estimator.h has it.
Assessment assess(const BatchSolution& solution, const BatchDoubts& doubts);

}  // namespace spindrift
