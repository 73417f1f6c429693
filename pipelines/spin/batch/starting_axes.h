/// @file
/// Where the estimator `batch` begins.

#pragma once

#include <Eigen/Core>
#include <vector>

namespace spindrift {

struct StartingAxes {
  std::vector<Eigen::Vector3d> axes_icrf;  ///< Unit, likeliest first.
  /// The true axis is near one of them beyond doubt. Otherwise all the sky is searched for others.
  bool settled = true;
};

}  // namespace spindrift
