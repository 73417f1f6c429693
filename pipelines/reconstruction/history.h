/// @file
/// Builds the attitude history from T1 on, and its events, from the estimates at nodes after T2.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/shared_errors.h"

namespace spindrift {

/// Holds the estimates in time order. The first node is at T2, and every event has a node.
struct NodeEstimates {
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> q_icrf_body;
  std::vector<Eigen::Matrix3d> own_rad2;  ///< Covariance if the shared errors were zero.
  std::vector<PerShared> per_shared;      ///< Derivative of the error by the shared errors.
  Eigen::Vector3d bias_rad_s;
  SharedErrors shared;
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
