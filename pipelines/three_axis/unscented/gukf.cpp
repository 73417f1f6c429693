#include "pipelines/three_axis/unscented/gukf.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/dynamics/disturbances.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Largest turn in a step of the integration: Runge-Kutta loses 2e-7 rad.
constexpr double kMostTurnInPart_rad = 0.2;
/// A wrong filter may turn ever faster.
constexpr double kMostParts = 100.0;

}  // namespace

UncertainMotion motion_between(const UncertainAttitude& first, const UncertainAttitude& second,
                               double dt_s) {
  const Quaterniond turn = first.q_ref_body.conjugate() * second.q_ref_body;
  const Vector3d rate_rad_s = rotation_vector_of(turn) / dt_s;
  const Matrix3d back = turn.conjugate().toRotationMatrix();
  const double may_change_rad_s = 0.5 * rate_rad_s.squaredNorm() * dt_s;
  UncertainMotion motion{
      .motion = {.q_icrf_body = second.q_ref_body, .rate_body_rad_s = rate_rad_s},
      .covariance = Eigen::Matrix<double, 6, 6>::Zero()};
  const Matrix3d& turn_rad2 = second.covariance_rad2;
  motion.covariance.topLeftCorner<3, 3>() = turn_rad2;
  motion.covariance.topRightCorner<3, 3>() = turn_rad2 / dt_s;
  motion.covariance.bottomLeftCorner<3, 3>() = turn_rad2 / dt_s;
  motion.covariance.bottomRightCorner<3, 3>() =
      (turn_rad2 + back * first.covariance_rad2 * back.transpose()) / (dt_s * dt_s) +
      may_change_rad_s * may_change_rad_s * Matrix3d::Identity();
  return motion;
}

Gukf::Gukf(const GukfModel& model, const UncertainMotion& start)
    : torque_noise2_{model.torque_noise_nm_rts * model.torque_noise_nm_rts} {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal{model.inertia_kg_m2};
  principal_axes_ = principal.eigenvectors();
  moments_kg_m2_ = principal.eigenvalues();
  estimate_.q_icrf_body = start.motion.q_icrf_body;
  estimate_.state.segment<3>(Rate) = start.motion.rate_body_rad_s;
  estimate_.covariance.topLeftCorner<6, 6>() = start.covariance;
  estimate_.covariance.block<3, 3>(Torque, Torque) =
      model.torque_sigma_nm * model.torque_sigma_nm * Matrix3d::Identity();
  estimate_.set_errors(model.alignment, {InertiaError, InertiaError + 1, InertiaError + 2});
  prior_sigma_ = estimate_.covariance.diagonal().cwiseSqrt();
}

double Gukf::most_prior_sigmas() const {
  double most = 0.0;
  for (int state = LogMoments; state < Estimate::kStates; ++state) {
    if (prior_sigma_[state] > 0.0) {
      most = std::max(most, std::abs(estimate_.state[state]) / prior_sigma_[state]);
    }
  }
  return most;
}

Gukf Gukf::started_again(const GukfModel& model, const UncertainMotion& start) const {
  Gukf again{model, start};
  again.estimate_.state.segment<3>(LogMoments) = log_moments();
  return again;
}

BodyState Gukf::after(const Quaterniond& q_icrf_body, const Estimate::Moving& state,
                      const Step& step) const {
  const Vector3d moments = moments_kg_m2_.array() * state.segment<3>(LogMoments).array().exp();
  const RigidBody body = RigidBody::with_moments(principal_axes_, moments);
  const double part_s = step.dt_s / step.parts;
  const Vector3d known_nm = step.torques.external_nm + state.segment<3>(Torque);
  BodyTorques now = step.torques;
  BodyState motion{.q_icrf_body = q_icrf_body, .rate_body_rad_s = state.segment<3>(Rate)};
  for (int part = 0; part < step.parts; ++part) {
    now.external_nm = known_nm;
    if (step.position_icrf_km) {
      const Quaterniond midway =
          motion.q_icrf_body * quaternion_by(0.5 * part_s * motion.rate_body_rad_s);
      now.external_nm +=
          gravity_gradient_nm(body.inertia_kg_m2(), midway.conjugate() * *step.position_icrf_km);
    }
    motion = body.after(motion, now, part_s);
    now.wheels_nms -= part_s * now.wheels_nm;
  }
  return motion;
}

void Gukf::propagate(double dt_s, const BodyTorques& torques,
                     const std::optional<Vector3d>& position_icrf_km) {
  const Estimate::Moving mean = estimate_.state.head<kMoving>();
  const double most_rad_s = mean.segment<3>(Rate).norm() +
                            std::sqrt(estimate_.covariance.block<3, 3>(Rate, Rate).trace());
  const double parts = std::min(kMostParts, most_rad_s * dt_s / kMostTurnInPart_rad);
  const Step step{.dt_s = dt_s,
                  .torques = torques,
                  .position_icrf_km = position_icrf_km,
                  .parts = 1 + static_cast<int>(parts)};
  const Quaterniond q_before = estimate_.q_icrf_body;
  const BodyState expected = after(q_before, mean, step);
  using Out = Eigen::Matrix<double, 6, 1>;
  estimate_.propagate<6>(expected.q_icrf_body, [&](const Estimate::Moving& away) {
    const BodyState moved =
        after(q_before * quaternion_of_rodrigues(away.head<3>()), mean + away, step);
    Out off;
    off << rodrigues_of(expected.q_icrf_body.conjugate() * moved.q_icrf_body),
        moved.rate_body_rad_s - expected.rate_body_rad_s;
    return off;
  });
  estimate_.state.segment<3>(Rate) += expected.rate_body_rad_s - mean.segment<3>(Rate);
  add_noise(dt_s);
}

/// Adds a random torque: the rate walks, and the turn is the integral of its walk.
void Gukf::add_noise(double dt_s) {
  const Matrix3d per_torque =
      principal_axes_ * moments_kg_m2_.cwiseInverse().asDiagonal() * principal_axes_.transpose();
  const Matrix3d walk = torque_noise2_ * dt_s * per_torque * per_torque;
  auto covariance = estimate_.covariance.topLeftCorner<6, 6>();
  covariance.topLeftCorner<3, 3>() += dt_s * dt_s / 3.0 * walk;
  covariance.topRightCorner<3, 3>() += 0.5 * dt_s * walk;
  covariance.bottomLeftCorner<3, 3>() += 0.5 * dt_s * walk;
  covariance.bottomRightCorner<3, 3>() += walk;
}

UnscentedInnovation Gukf::innovation(const SeenField& field) const {
  return estimate_.innovation(field, rate_rad_s());
}
UnscentedInnovation Gukf::innovation(const SeenSun& sun) const {
  return estimate_.innovation(sun, rate_rad_s());
}
UnscentedInnovation Gukf::innovation(const SeenStars& stars) const {
  return estimate_.innovation(stars, rate_rad_s());
}
void Gukf::update(const SeenField& field) { estimate_.update(field, rate_rad_s()); }
void Gukf::update(const SeenSun& sun) { estimate_.update(sun, rate_rad_s()); }
void Gukf::update(const SeenStars& stars) { estimate_.update(stars, rate_rad_s()); }

}  // namespace spindrift
