/// @file
/// Forward selection of biases: significant ones are estimated, one after the other.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/spin/batch/evaluated_fit.h"

namespace spindrift {

struct BiasSelection {
  EvaluatedFit best;          ///< With all that are wanted.
  Eigen::Matrix2d open_rad2;  ///< What the choice among them leaves open of the axis, tilts.
};

/// @return As fit().
Expected<BiasSelection> select_biases(const PassModel& model, std::span<const PassEdge> edges,
                                      EvaluatedFit without);

}  // namespace spindrift
