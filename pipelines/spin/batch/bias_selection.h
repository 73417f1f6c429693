/// @file
/// Forward selection of biases: significant biases are added to the fit one after the other.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/spin/batch/evaluated_fit.h"

namespace spindrift {

struct BiasSelection {
  EvaluatedFit best;          ///< Fit with all significant biases estimated.
  Eigen::Matrix2d open_rad2;  ///< Axis uncertainty from the choice among biases, tilts.
};

/// @return The errors of fit().
Expected<BiasSelection> select_biases(const PassModel& model, std::span<const PassEdge> edges,
                                      EvaluatedFit without);

}  // namespace spindrift
