/// @file
/// The prior that an operator gives who chooses one of the axes that a revolution leaves possible.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <numbers>
#include <span>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {

/// So narrow that the nearest of the others is three sigmas away.
/// @param root_icrf, others_icrf Unit; one other at least.
inline SpinPrior prior_choosing(const Eigen::Vector3d& root_icrf,
                                std::span<const Eigen::Vector3d> others_icrf) {
  double nearest_rad = std::numbers::pi;
  for (const Eigen::Vector3d& other_icrf : others_icrf) {
    nearest_rad = std::min(nearest_rad, angle_between_rad(root_icrf, other_icrf));
  }
  return {.axis_icrf = root_icrf, .sigma_rad = nearest_rad / kPriorSigmas};
}

}  // namespace spindrift
