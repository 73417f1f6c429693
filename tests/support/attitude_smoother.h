/// @file
/// A multiplicative extended Kalman filter with gyro bias and a Rauch-Tung-Striebel smoother over
/// it: an independent method to compare the batch solution with.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "pipelines/reconstruction/observations.h"

namespace spindrift::testing {

struct SmoothedAttitude {
  double t_s;
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d bias_rad_s;
  /// Covariance of the rotation about body axes, then of the bias.
  Eigen::Matrix<double, 6, 6> covariance;
};

struct SmootherNoise {
  double sun_rad;
  double star_rad;
  double bias_rad_s;
};

/// @param all Observations; the filter starts at the first star fix (event T2).
std::vector<SmoothedAttitude> smoothed(const Observations& all, const SmootherNoise& noise);

}  // namespace spindrift::testing
