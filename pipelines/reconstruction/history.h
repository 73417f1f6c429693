/// @file
/// Builds the attitude history from T1 on, and its events, from the estimates at nodes after T2.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// Holds the estimates in time order. The first node is at T2, and every event has a node.
struct NodeEstimates {
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> q_icrf_body;
  std::vector<Eigen::Matrix3d> covariances_rad2;
  Eigen::Vector3d bias_rad_s;
  Eigen::Matrix3d bias_covariance_rad2_s2;
  Eigen::Matrix3d start_bias_covariance;  ///< Covariance of rotation at T2 with the bias.
  double gyro_noise_rad_s;
};

struct History {
  std::vector<ReconstructedAttitude> attitudes;
  std::vector<std::size_t> events;  ///< Index of each event in `attitudes`.
};

History history_of(const ReconstructionRequest& request, const Observations& all,
                   const NodeEstimates& nodes);

std::vector<ReconstructedEvent> events_of(const Observations& all, const History& history);

}  // namespace spindrift
