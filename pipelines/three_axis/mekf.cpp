#include "pipelines/three_axis/mekf.h"

#include <Eigen/Cholesky>
#include <optional>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"
#include "pipelines/statistics/linear_update.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Holds a measurement linearised at an attitude as a turn relative to it.
template <int kSize>
struct Seen {
  Eigen::Matrix<double, kSize, 1> turn_rad;
  Eigen::Matrix<double, kSize, 3> axes;  ///< Rows: body axes of the measured turn.
};

/// Measures the turn about two axes across the direction.
Seen<2> seen_from(const Eigen::Quaterniond& q_icrf_body, const ObservedDirection& direction) {
  const Vector3d expected = (q_icrf_body.conjugate() * direction.ref).normalized();
  const Eigen::Quaterniond to_expected = shortest_turn(direction.body, expected);
  const Vector3d first = expected.unitOrthogonal();
  Seen<2> seen;
  seen.axes.row(0) = first;
  seen.axes.row(1) = expected.cross(first);
  seen.turn_rad = seen.axes * rotation_vector_of(to_expected);
  return seen;
}

Seen<3> seen_from(const Eigen::Quaterniond& q_icrf_body, const ObservedAttitude& attitude) {
  return {.turn_rad = rotation_vector_of(q_icrf_body.conjugate() * attitude.q_icrf_body),
          .axes = Matrix3d::Identity()};
}

}  // namespace

/// The cross product is the second term of the Magnus expansion and accounts for a moving axis.
Vector3d turned_rad(const RateSpan& span, const Vector3d& bias_rad_s) {
  const Vector3d from_rad_s = span.from_rad_s - bias_rad_s;
  const Vector3d to_rad_s = span.to_rad_s - bias_rad_s;
  return 0.5 * span.dt_s * (from_rad_s + to_rad_s) +
         span.dt_s * span.dt_s / 12.0 * from_rad_s.cross(to_rad_s);
}

Mekf::Mekf(const UncertainAttitude& attitude, double bias_sigma_rad_s)
    : q_icrf_body_{attitude.q_ref_body} {
  covariance_.topLeftCorner<3, 3>() = attitude.covariance_rad2;
  covariance_.bottomRightCorner<3, 3>() =
      bias_sigma_rad_s * bias_sigma_rad_s * Matrix3d::Identity();
}

/// The error propagates as turn' = R^T turn - J dt more.
void Mekf::propagate(const RateSpan& span, const SpanErrors& errors) {
  const Vector3d vector_rad = turned_rad(span, bias_rad_s_);
  const Eigen::Quaterniond q = quaternion_by(vector_rad);
  q_icrf_body_ = (q_icrf_body_ * q).normalized();

  const Matrix3d back = q.conjugate().toRotationMatrix();
  const Matrix3d per_bias = -span.dt_s * right_jacobian(vector_rad);
  const Matrix3d turn = covariance_.topLeftCorner<3, 3>();
  const Matrix3d cross = covariance_.topRightCorner<3, 3>();
  const Matrix3d bias = covariance_.bottomRightCorner<3, 3>();
  const Matrix3d cross_turned = back * cross + per_bias * bias;
  const Matrix3d mixed = back * cross * per_bias.transpose();
  covariance_.topLeftCorner<3, 3>() = back * turn * back.transpose() + mixed + mixed.transpose() +
                                      per_bias * bias * per_bias.transpose() +
                                      errors.turn_rad2 * Matrix3d::Identity();
  covariance_.topRightCorner<3, 3>() = cross_turned;
  covariance_.bottomLeftCorner<3, 3>() = cross_turned.transpose();
  covariance_.bottomRightCorner<3, 3>() += errors.bias_rad2_s2 * Matrix3d::Identity();
}

template <int kSize, class Observed>
Mekf::Innovation Mekf::innovation_of(const Observed& observed) const {
  const Seen<kSize> seen = seen_from(q_icrf_body_, observed);
  const Eigen::Matrix<double, kSize, kSize> expected =
      seen.axes * covariance_.topLeftCorner<3, 3>() * seen.axes.transpose() +
      observed.sigma_rad * observed.sigma_rad * Eigen::Matrix<double, kSize, kSize>::Identity();
  Innovation innovation{.residual = {.freedom = kSize},
                        .nis = seen.turn_rad.dot(expected.llt().solve(seen.turn_rad))};
  innovation.residual.value.template head<kSize>() = seen.turn_rad;
  innovation.residual.sigma.template head<kSize>() = expected.diagonal().cwiseSqrt();
  return innovation;
}

/// Runs a Gauss-Newton iteration on prior and measurement. Each pass is a Kalman update from the
/// prior, linearised at the result of the previous pass.
template <int kSize, class Observed>
void Mekf::work_in(const Observed& observed) {
  using Update = LinearUpdate<6, kSize>;
  const typename Update::Noise noise =
      observed.sigma_rad * observed.sigma_rad * Update::Noise::Identity();
  typename Update::Slope slope = Update::Slope::Zero();
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
  std::optional<Update> update;
  for (int pass = 0; pass < kMostLinearisations; ++pass) {
    const Vector3d here_rad = error.head<3>();
    const Seen<kSize> seen = seen_from(q_icrf_body_ * quaternion_by(here_rad), observed);
    slope.template leftCols<3>() = seen.axes * right_jacobian(here_rad);
    update.emplace(covariance_, slope, noise);
    error = update->gain * (seen.turn_rad + slope.template leftCols<3>() * here_rad);
    if ((error.head<3>() - here_rad).norm() < kFarFromLinear_rad) {
      break;
    }
  }
  // Moves the turn into the quaternion and refers the covariance to the new body axes.
  const Matrix3d moved = right_jacobian(error.head<3>());
  covariance_ = update->left_of(covariance_);
  covariance_.topRows<3>() = moved * covariance_.topRows<3>();
  covariance_.leftCols<3>() = covariance_.leftCols<3>() * moved.transpose();
  q_icrf_body_ = (q_icrf_body_ * quaternion_by(error.head<3>())).normalized();
  bias_rad_s_ += error.tail<3>();
}

Mekf::Innovation Mekf::innovation(const ObservedDirection& direction) const {
  return innovation_of<2>(direction);
}
Mekf::Innovation Mekf::innovation(const ObservedAttitude& attitude) const {
  return innovation_of<3>(attitude);
}
void Mekf::update(const ObservedDirection& direction) { work_in<2>(direction); }
void Mekf::update(const ObservedAttitude& attitude) { work_in<3>(attitude); }

}  // namespace spindrift
