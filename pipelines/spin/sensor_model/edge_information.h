/// @file
/// Predicts the information of edges on the spin axis: Fisher's information, and the Cramer-Rao
/// bound, which no unbiased estimator can beat.
///
/// Each edge is one equation (as in spin_filter.h)
///
///     phase + rate dt + drift dt^2/2 - predicted phase = 0 +/- sigma
///
/// in the tilts of the axis about the first and second axis of the frame `spin`, and in phase, rate
/// and drift, which have no prior.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/spin/sensor_model/edge_prediction.h"

namespace spindrift {

class EdgeInformation {
 public:
  /// @param edge Predicted edge; all edges need the same frame `spin`.
  /// @param dt_s Time from an epoch common to all edges.
  /// @param sigma_rad Standard deviation of the phase: spin rate times that of the edge time.
  /// @param weight Number of such edges.
  void add(const PredictedEdge& edge, double dt_s, double sigma_rad, double weight = 1.0);

  /// Returns the covariance of the axis along the first and second axis of the frame. Empty if its
  /// standard deviation exceeds half a radian in some direction, where slopes mean nothing.
  std::optional<Eigen::Matrix2d> axis_covariance_rad2() const;

 private:
  Eigen::Matrix<double, 5, 5> normal_ = Eigen::Matrix<double, 5, 5>::Zero();
};

}  // namespace spindrift
