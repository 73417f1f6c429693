#include "pipelines/spin/mean_axis.h"

#include "pipelines/frames/celestial.h"

namespace spindrift {

void MeanAxis::add(const SpinFix& fix) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(fix.axis_icrf);
  sum_icrf_ += fix.axis_icrf;
  covariance_sum_rad2_ += basis * fix.covariance_rad2 * basis.transpose();
  ++count_;
}

Eigen::Matrix2d MeanAxis::covariance_rad2() const {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis_icrf());
  const auto count = static_cast<double>(count_);
  return basis.transpose() * covariance_sum_rad2_ * basis / (count * count);
}

void AxisWindow::add(const Eigen::Vector3d& axis_icrf) {
  axes_icrf_.push_back(axis_icrf);
  if (axes_icrf_.size() > length_) {
    axes_icrf_.pop_front();
  }
}

std::optional<Eigen::Vector3d> AxisWindow::axis_icrf() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& axis : axes_icrf_) {
    sum += axis;
  }
  const double length = sum.norm();
  if (!(length > 0.0)) {
    return std::nullopt;
  }
  return sum / length;
}

}  // namespace spindrift
