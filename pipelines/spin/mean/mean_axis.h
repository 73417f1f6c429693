/// @file
/// Mean attitude: the normalised mean of unit vectors, each weighted by its own accuracy, since
/// fixes of different cases differ tenfold. (Averaging right ascensions breaks across 0 h and at
/// the poles.)

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>

#include "pipelines/spin/types/products.h"

namespace spindrift {

/// Mean of all fixes of a pass, and the covariance that their own covariances give it.
class MeanAxis {
 public:
  void add(const SpinFix& fix);
  void add(const Eigen::Vector3d& axis_icrf, const Eigen::Matrix2d& covariance_rad2);

  std::size_t count() const { return count_; }
  /// Unit; at least one fix must have been added.
  Eigen::Vector3d axis_icrf() const { return sum_icrf_.normalized(); }
  /// In the tangent plane at the mean: east, north. Fixes of different revolutions share no edge,
  /// so their errors add in quadrature.
  Eigen::Matrix2d covariance_rad2() const;
  /// How many times the squares of the fixes' distances from the mean are what their covariances
  /// make them, where that is significantly more than 1; else 1.
  double excess_scatter() const;

 private:
  Eigen::Vector3d sum_icrf_ = Eigen::Vector3d::Zero();  ///< Weighted, as the following.
  Eigen::Matrix3d covariance_sum_ = Eigen::Matrix3d::Zero();
  double weight_sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Mean of the last fixes: the attitude that the rationality test predicts from.
class AxisWindow {
 public:
  explicit AxisWindow(std::size_t length) : length_{length} {}

  void add(const SpinFix& fix);
  /// Unit; empty before the first fix, and where the fixes cancel.
  std::optional<Eigen::Vector3d> axis_icrf() const;

 private:
  std::size_t length_;
  std::deque<Eigen::Vector3d> weighted_icrf_;
};

}  // namespace spindrift
