/// @file
/// Axes at which the estimator `batch` starts.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/spin/types/products.h"

namespace spindrift {

struct StartingAxes {
  std::vector<Eigen::Vector3d> axes_icrf;  ///< Unit vectors, likeliest first.
  /// True when the true axis is surely near one of them; otherwise the whole sky is searched.
  bool settled = true;
  /// Earlier choice of the pass; its other axis is compared with the solution, but is no start.
  std::optional<AxisChoice> of_pass = {};
};

}  // namespace spindrift
