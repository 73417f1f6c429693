/// @file
/// Prior for an axis that an operator chose among those that a revolution leaves possible.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numbers>
#include <span>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {

/// Returns a prior so narrow that the nearest other axis is three sigmas away.
/// @param root_icrf, others_icrf Unit vectors; at least one other.
inline SpinPrior prior_choosing(const Eigen::Vector3d& root_icrf,
                                std::span<const Eigen::Vector3d> others_icrf) {
  double nearest_rad = std::numbers::pi;
  for (const Eigen::Vector3d& other_icrf : others_icrf) {
    nearest_rad = std::min(nearest_rad, angle_between_rad(root_icrf, other_icrf));
  }
  return {.axis_icrf = root_icrf, .sigma_rad = nearest_rad / kPriorSigmas};
}

}  // namespace spindrift
