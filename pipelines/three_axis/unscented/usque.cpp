#include "pipelines/three_axis/unscented/usque.h"

#include <Eigen/LU>

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Returns the matrix that turns what the gyro measures, less its bias, into the rate.
/// @param errors Scale of three axes, then the six errors of the axes, row by row.
Matrix3d rate_per_measured(const Eigen::Matrix<double, 9, 1>& errors) {
  Matrix3d measured_per_rate = Matrix3d::Identity();
  measured_per_rate.diagonal() += errors.head<3>();
  int error = 3;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (column != row) {
        measured_per_rate(row, column) = errors[error++];
      }
    }
  }
  return measured_per_rate.inverse();
}

}  // namespace

Usque::Usque(const UncertainAttitude& start, double bias_sigma_rad_s,
             const AttitudeAlignment& alignment) {
  estimate_.q_icrf_body = start.q_ref_body;
  estimate_.covariance.topLeftCorner<3, 3>() = start.covariance_rad2;
  estimate_.covariance.block<3, 3>(Bias, Bias) =
      bias_sigma_rad_s * bias_sigma_rad_s * Matrix3d::Identity();
  estimate_.set_errors(alignment, {GyroScaleError, GyroScaleError + 1, GyroScaleError + 2,
                                   GyroAxisError, GyroAxisError + 1, GyroAxisError + 2,
                                   GyroAxisError + 3, GyroAxisError + 4, GyroAxisError + 5});
}

Quaterniond Usque::turned(const Quaterniond& q_icrf_body, const Estimate::Moving& state,
                          const RateSpan& span) const {
  const Matrix3d per_measured = rate_per_measured(state.tail<9>());
  const Vector3d bias_rad_s = state.segment<3>(Bias);
  const RateSpan rates{.dt_s = span.dt_s,
                       .from_rad_s = per_measured * (span.from_rad_s - bias_rad_s),
                       .to_rad_s = per_measured * (span.to_rad_s - bias_rad_s)};
  return (q_icrf_body * quaternion_by(turned_rad(rates, Vector3d::Zero()))).normalized();
}

void Usque::propagate(const RateSpan& span, const SpanErrors& errors) {
  const Estimate::Moving mean = estimate_.state.head<kMoving>();
  const Quaterniond q_before = estimate_.q_icrf_body;
  const Quaterniond q_after = turned(q_before, mean, span);
  estimate_.propagate<3>(q_after, [&](const Estimate::Moving& away) -> Vector3d {
    return rodrigues_of(
        q_after.conjugate() *
        turned(q_before * quaternion_of_rodrigues(away.head<3>()), mean + away, span));
  });
  estimate_.covariance.topLeftCorner<3, 3>() += errors.turn_rad2 * Matrix3d::Identity();
  estimate_.covariance.block<3, 3>(Bias, Bias) += errors.bias_rad2_s2 * Matrix3d::Identity();
  measured_rad_s_ = span.to_rad_s;
}

Vector3d Usque::rate_rad_s() const {
  return rate_per_measured(estimate_.state.segment<9>(Scale)) * (measured_rad_s_ - bias_rad_s());
}

UnscentedInnovation Usque::innovation(const SeenField& field) const {
  return estimate_.innovation(field, rate_rad_s());
}
UnscentedInnovation Usque::innovation(const SeenSun& sun) const {
  return estimate_.innovation(sun, rate_rad_s());
}
UnscentedInnovation Usque::innovation(const SeenStars& stars) const {
  return estimate_.innovation(stars, rate_rad_s());
}
void Usque::update(const SeenField& field) { estimate_.update(field, rate_rad_s()); }
void Usque::update(const SeenSun& sun) { estimate_.update(sun, rate_rad_s()); }
void Usque::update(const SeenStars& stars) { estimate_.update(stars, rate_rad_s()); }

}  // namespace spindrift
