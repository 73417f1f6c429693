/// @file
/// What edges say of the spin axis, before any has come: Fisher's information, and the Cramer-Rao
/// bound, which no unbiased estimator can beat.
///
/// Each edge is one equation (as in spin_filter.h)
///
///     phase + rate dt + drift dt^2/2 - predicted phase = 0 +/- sigma
///
/// in the tilts of the axis about the first and second axis of the frame `spin`, and in phase, rate
/// and drift, of which nothing is known beforehand.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/spin/sensor_model/edge_prediction.h"

namespace spindrift {

class EdgeInformation {
 public:
  /// @param edge All in the same frame `spin`.
  /// @param dt_s From an instant that is the same for all.
  /// @param sigma_rad One standard deviation of its phase: spin rate times that of its time.
  /// @param weight How many such edges.
  void add(const PredictedEdge& edge, double dt_s, double sigma_rad, double weight = 1.0);

  /// Of the axis, along the first and second axis of the frame. Empty: its standard deviation is
  /// more than half a radian in some direction, where slopes mean nothing.
  std::optional<Eigen::Matrix2d> axis_covariance_rad2() const;

 private:
  Eigen::Matrix<double, 5, 5> normal_ = Eigen::Matrix<double, 5, 5>::Zero();
};

}  // namespace spindrift
