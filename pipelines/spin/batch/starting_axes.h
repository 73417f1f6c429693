/// @file
/// Where the estimator `batch` begins.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/spin/types/products.h"

namespace spindrift {

struct StartingAxes {
  std::vector<Eigen::Vector3d> axes_icrf;  ///< Unit, likeliest first.
  /// The true axis is near one of them beyond doubt. Otherwise all the sky is searched for others.
  bool settled = true;
  /// What the pass has taken; its other axis is compared with the solution, but is no start.
  std::optional<AxisChoice> of_pass = {};
};

}  // namespace spindrift
