#include "pipelines/spin/mean/mean_axis.h"

#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

/// Returns the weight of a fix, 1/rad^2.
double weight_of(const Eigen::Matrix2d& covariance_rad2) { return 1.0 / covariance_rad2.trace(); }

}  // namespace

void MeanAxis::add_fix(const SpinFix& fix) {
  add_fix(fix.axis_icrf, fix.covariance_rad2, fix.alignment_rad2);
}

void MeanAxis::add_fix(const Eigen::Vector3d& axis_icrf, const Eigen::Matrix2d& covariance_rad2,
                       const Eigen::Matrix2d& alignment_rad2) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis_icrf);
  const Eigen::Matrix2d noise_rad2 = covariance_rad2 - alignment_rad2;
  const double weight = weight_of(noise_rad2);
  sum_icrf_ += weight * axis_icrf;
  covariance_sum_ += weight * weight * basis * noise_rad2 * basis.transpose();
  alignment_sum_ += weight * basis * alignment_rad2 * basis.transpose();
  weight_sum_ += weight;
  ++count_;
}

Eigen::Matrix2d MeanAxis::covariance_rad2() const {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis_icrf());
  return basis.transpose() * covariance_sum_ * basis / (weight_sum_ * weight_sum_);
}

Eigen::Matrix2d MeanAxis::alignment_rad2() const {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis_icrf());
  return basis.transpose() * alignment_sum_ * basis / weight_sum_;
}

double MeanAxis::excess_scatter() const {
  const double freedom = static_cast<double>(count_) - 1.0;
  if (freedom < 1.0) {
    return 1.0;
  }
  const double scatter = (weight_sum_ - sum_icrf_.squaredNorm() / weight_sum_) / freedom;
  // The sum of squares is a chi-square with at least one degree of freedom per fix.
  return variance_factor(scatter, freedom);
}

void AxisWindow::add_fix(const SpinFix& fix) {
  weighted_icrf_.emplace_back(weight_of(fix.covariance_rad2 - fix.alignment_rad2) * fix.axis_icrf);
  if (weighted_icrf_.size() > length_) {
    weighted_icrf_.pop_front();
  }
}

std::optional<Eigen::Vector3d> AxisWindow::axis_icrf() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& axis : weighted_icrf_) {
    sum += axis;
  }
  const double length = sum.norm();
  if (!(length > 0.0)) {
    return std::nullopt;
  }
  return sum / length;
}

}  // namespace spindrift
