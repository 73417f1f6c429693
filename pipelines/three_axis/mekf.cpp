#include "pipelines/three_axis/mekf.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/shortest_turn.h"
#include "pipelines/statistics/linear_update.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

}  // namespace

/// A measurement linearised at an attitude as a turn relative to it. The strength of a field, as a
/// fraction, is the third component of a direction; no turn changes it.
template <int kSize>
struct Mekf::Seen {
  Eigen::Matrix<double, kSize, 1> turn_rad;
  Eigen::Matrix<double, kSize, 3> axes;  ///< Rows: body axes of the measured turn.
  Eigen::Matrix<double, kSize, kFilterErrors> per_error;
  double sigma_rad;  ///< Noise of each component.
};

/// Measures the turn about two axes across the direction.
template <int kSize>
Mekf::Seen<kSize> Mekf::seen_from(const Eigen::Quaterniond& q_icrf_body,
                                  const SeenDirection& seen) const {
  const ObservedDirection& direction = seen.direction;
  const Vector3d true_body = q_icrf_body.conjugate() * direction.ref;
  const Vector3d expected = true_body.normalized();
  const Eigen::Quaterniond to_expected = shortest_turn(direction.body, expected);
  const Vector3d first = expected.unitOrthogonal();
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = first;
  across.row(1) = expected.cross(first);
  const Eigen::Matrix<double, 2, 1> turn_rad = across * rotation_vector_of(to_expected);
  const Eigen::Matrix<double, 2, kFilterErrors> per_error =
      across * direction_per_error(seen.kind, true_body, rate_rad_s_);
  if constexpr (kSize == 2) {
    return {turn_rad, across, per_error, direction.sigma_rad};
  } else {
    Seen<3> with_strength{Vector3d::Zero(), Matrix3d::Zero(), TurnPerError::Zero(),
                          direction.sigma_rad};
    with_strength.turn_rad << turn_rad, *seen.stronger * direction.sigma_rad;
    with_strength.axes.topRows<2>() = across;
    with_strength.per_error.topRows<2>() = per_error;
    with_strength.per_error.block<1, 3>(2, MagnetometerBiasError) =
        expected.transpose() / direction.ref.norm();
    return with_strength;
  }
}

template <int kSize>
Mekf::Seen<kSize> Mekf::seen_from(const Eigen::Quaterniond& q_icrf_body,
                                  const ObservedAttitude& attitude) const {
  return {rotation_vector_of(q_icrf_body.conjugate() * attitude.q_icrf_body), Matrix3d::Identity(),
          star_per_error(rate_rad_s_), attitude.sigma_rad};
}

Mekf::Mekf(const SensitiveAttitude& attitude, double bias_sigma_rad_s,
           const FilterAlignment& alignment)
    : q_icrf_body_{attitude.q_ref_body}, evidence_{alignment} {
  covariance_.topLeftCorner<3, 3>() = attitude.covariance_rad2;
  covariance_.bottomRightCorner<3, 3>() =
      bias_sigma_rad_s * bias_sigma_rad_s * Matrix3d::Identity();
  per_error_.topRows<3>() = attitude.per_error;
}

/// The error propagates as turn' = R^T turn - J dt more.
void Mekf::propagate(const RateSpan& span, const SpanErrors& errors) {
  const Vector3d vector_rad = turned_rad(span, bias_rad_s_);
  const Eigen::Quaterniond q = quaternion_by(vector_rad);
  q_icrf_body_ = (q_icrf_body_ * q).normalized();

  const Matrix3d back = q.conjugate().toRotationMatrix();
  const Matrix3d jacobian = right_jacobian(vector_rad);
  const Matrix3d per_bias = -span.dt_s * jacobian;
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

  const TurnPerError by_bias = per_bias * per_error_.bottomRows<3>();
  per_error_.topRows<3>() = turned(per_error_.topRows<3>(), vector_rad, back, jacobian) + by_bias;
  rate_rad_s_ = span.to_rad_s - bias_rad_s_;

  const Matrix3d by_turn = back * turn_noise_.leftCols<3>() * back.transpose();
  turn_noise_.rightCols<3>() = back * turn_noise_.rightCols<3>();
  turn_noise_.leftCols<3>() = by_turn + turn_noise_.rightCols<3>() * per_bias.transpose() +
                              errors.turn_rad2 * Matrix3d::Identity();
}

/// Errors of scale and axes act on the true turn. The noise of the measured turn also moves the
/// attitude, so that the innovations would seem to measure these errors. What the innovation says
/// of that noise is taken out.
/// @param weighted Innovation by its covariance, in the components of the error.
void Mekf::correct_turn(const Eigen::Matrix<double, 6, 1>& weighted) {
  per_error_.topRows<3>() = turned(per_error_.topRows<3>(), turn_noise_ * weighted,
                                   Matrix3d::Identity(), Matrix3d::Identity());
}

template <int kSize>
Mekf::Innovation Mekf::innovation_of(const Seen<kSize>& seen) const {
  const Eigen::Matrix<double, kSize, kFilterErrors> per_error =
      seen.axes * per_error_.topRows<3>() + seen.per_error;
  const Eigen::Matrix<double, kSize, kSize> expected =
      seen.axes * covariance_.topLeftCorner<3, 3>() * seen.axes.transpose() +
      seen.sigma_rad * seen.sigma_rad * Eigen::Matrix<double, kSize, kSize>::Identity() +
      per_error * evidence_.prior() * per_error.transpose();
  Innovation innovation{.residual = {.freedom = kSize},
                        .nis = seen.turn_rad.dot(expected.llt().solve(seen.turn_rad))};
  innovation.residual.value.template head<kSize>() = seen.turn_rad;
  innovation.residual.sigma.template head<kSize>() = expected.diagonal().cwiseSqrt();
  return innovation;
}

/// Runs a Gauss-Newton iteration on prior and measurement. Each pass is a Kalman update from the
/// prior, linearised at the result of the previous pass.
template <int kSize, class Observed>
double Mekf::work_in(const Observed& observed) {
  using Update = LinearUpdate<6, kSize>;
  typename Update::Slope slope = Update::Slope::Zero();
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, kSize, kFilterErrors> per_error;
  std::optional<Update> update;
  double left = 0.0;
  for (int pass = 0; pass < kMostLinearisations; ++pass) {
    const Vector3d here_rad = error.head<3>();
    const auto seen = seen_from<kSize>(q_icrf_body_ * quaternion_by(here_rad), observed);
    slope.template leftCols<3>() = seen.axes * right_jacobian(here_rad);
    update.emplace(covariance_, slope, seen.sigma_rad * seen.sigma_rad * Update::Noise::Identity());
    if (pass == 0) {
      correct_turn(slope.transpose() * update->expected.llt().solve(seen.turn_rad));
    }
    per_error = slope * per_error_ + seen.per_error;
    if (pass == 0) {
      left = evidence_.add<kSize>(seen.turn_rad, per_error, update->expected);
    }
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
  rate_rad_s_ -= error.tail<3>();
  per_error_ -= update->gain * per_error;
  const Covariance left_of_error = Covariance::Identity() - update->gain * slope;
  turn_noise_ = left_of_error.topLeftCorner<3, 3>() * turn_noise_ * left_of_error.transpose();
  per_error_.topRows<3>() = moved * per_error_.topRows<3>();
  return left;
}

Mekf::Innovation Mekf::innovation(const SeenDirection& seen) const {
  return seen.stronger ? innovation_of<3>(seen_from<3>(q_icrf_body_, seen))
                       : innovation_of<2>(seen_from<2>(q_icrf_body_, seen));
}
Mekf::Innovation Mekf::innovation(const ObservedAttitude& attitude) const {
  return innovation_of<3>(seen_from<3>(q_icrf_body_, attitude));
}
Mekf::Innovation Mekf::innovation(const Mekf& other) const {
  const double sigma_rad = std::sqrt(other.covariance_.topLeftCorner<3, 3>().trace() / 3.0);
  return innovation_of<3>({rotation_vector_of(q_icrf_body_.conjugate() * other.q_icrf_body_),
                           Matrix3d::Identity(), -other.per_error_.topRows<3>(), sigma_rad});
}
double Mekf::update(const SeenDirection& seen) {
  return seen.stronger ? work_in<3>(seen) : work_in<2>(seen);
}
double Mekf::update(const ObservedAttitude& attitude) { return work_in<3>(attitude); }

Mekf::Covariance Mekf::covariance() const {
  return covariance_ + per_error_ * evidence_.prior() * per_error_.transpose();
}

Matrix3d Mekf::attitude_covariance_rad2(double noise_factor) const {
  const TurnPerError per_error = per_error_.topRows<3>();
  return noise_factor * attitude_noise_rad2() +
         per_error * evidence_.prior() * per_error.transpose();
}

}  // namespace spindrift
