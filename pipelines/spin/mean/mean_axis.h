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

/// Mean of all fixes of a pass, with the covariance that follows from the fixes' covariances.
class MeanAxis {
 public:
  void add_fix(const SpinFix& fix);
  /// @param covariance_rad2 Total covariance. @param alignment_rad2 Its part by the mission file.
  void add_fix(const Eigen::Vector3d& axis_icrf, const Eigen::Matrix2d& covariance_rad2,
               const Eigen::Matrix2d& alignment_rad2 = Eigen::Matrix2d::Zero());

  std::size_t count() const { return count_; }
  /// Mean axis, unit vector; at least one fix must have been added.
  Eigen::Vector3d axis_icrf() const { return sum_icrf_.normalized(); }
  /// Covariance by noise in the tangent plane at the mean: east, north. Fixes of different
  /// revolutions share no edge, so their errors add in quadrature.
  Eigen::Matrix2d covariance_rad2() const;
  /// Covariance that errors of the mission file add: the mean of those of the fixes, as all share
  /// these errors.
  Eigen::Matrix2d alignment_rad2() const;
  /// Returns the ratio of the fixes' observed to stated variance about the mean, where
  /// significantly more than 1; else 1.
  double excess_scatter() const;

 private:
  Eigen::Vector3d sum_icrf_ = Eigen::Vector3d::Zero();  ///< Weighted sum of the axes.
  Eigen::Matrix3d covariance_sum_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d alignment_sum_ = Eigen::Matrix3d::Zero();
  double weight_sum_ = 0.0;
  std::size_t count_ = 0;
};

/// Mean of the last fixes, from which the rationality test predicts angles.
class AxisWindow {
 public:
  explicit AxisWindow(std::size_t length) : length_{length} {}

  void add_fix(const SpinFix& fix);
  /// Unit vector; empty before the first fix, and where the fixes cancel.
  std::optional<Eigen::Vector3d> axis_icrf() const;

 private:
  std::size_t length_;
  std::deque<Eigen::Vector3d> weighted_icrf_;
};

}  // namespace spindrift
