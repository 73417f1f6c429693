/// @file
/// A multiplicative extended Kalman filter with gyro bias, and the smoother of Rauch, Tung and
/// Striebel over it: a peer of the batch solution.

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
  Eigen::Matrix<double, 6, 6> covariance;  ///< Rotation about body axes, bias.
};

struct SmootherNoise {
  double sun_rad;
  double star_rad;
  double bias_rad_s;
};

/// @param all The first star fix at T2: there it begins.
std::vector<SmoothedAttitude> smoothed(const Observations& all, const SmootherNoise& noise);

}  // namespace spindrift::testing
