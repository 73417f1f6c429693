#include "pipelines/ground_model/dynamics/rigid_body.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "pipelines/frames/inertia.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Change {
  Eigen::Vector4d q_icrf_body;  ///< Derivative of the quaternion, components x, y, z, w, in 1/s.
  Vector3d rate_rad_s2;
};

/// @param t_s Time since the start of the step.
Change change_of(const RigidBody& body, const BodyState& state, const BodyTorques& torques,
                 double t_s) {
  Eigen::Quaterniond rate{0.0, 0.0, 0.0, 0.0};
  rate.vec() = 0.5 * state.rate_body_rad_s;
  return {.q_icrf_body = (state.q_icrf_body * rate).coeffs(),
          .rate_rad_s2 = body.acceleration_rad_s2(state.rate_body_rad_s,
                                                  torques.external_nm + torques.wheels_nm,
                                                  torques.wheels_nms - t_s * torques.wheels_nm)};
}

BodyState changed(const BodyState& state, const Change& change, double step_s) {
  return {
      .q_icrf_body = Eigen::Quaterniond{state.q_icrf_body.coeffs() + step_s * change.q_icrf_body},
      .rate_body_rad_s = state.rate_body_rad_s + step_s * change.rate_rad_s2};
}

}  // namespace

Expected<RigidBody> RigidBody::make(const Matrix3d& inertia_kg_m2) {
  if (!is_inertia(inertia_kg_m2)) {
    const Vector3d moments = inertia_kg_m2.selfadjointView<Eigen::Lower>().eigenvalues();
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("an inertia with the principal moments {:.6g}, {:.6g} and {:.6g} kg m2: must "
                     "be symmetric, each moment positive and not above the sum of the others",
                     moments[0], moments[1], moments[2])}};
  }
  return RigidBody{inertia_kg_m2, inertia_kg_m2.ldlt().solve(Matrix3d::Identity())};
}

RigidBody RigidBody::with_moments(const Matrix3d& axes, const Vector3d& moments_kg_m2) {
  return {axes * moments_kg_m2.asDiagonal() * axes.transpose(),
          axes * moments_kg_m2.cwiseInverse().asDiagonal() * axes.transpose()};
}

BodyState RigidBody::after(const BodyState& state, const BodyTorques& torques,
                           double step_s) const {
  const double half_s = 0.5 * step_s;
  const Change first = change_of(*this, state, torques, 0.0);
  const Change second = change_of(*this, changed(state, first, half_s), torques, half_s);
  const Change third = change_of(*this, changed(state, second, half_s), torques, half_s);
  const Change fourth = change_of(*this, changed(state, third, step_s), torques, step_s);
  const Change mean = {
      .q_icrf_body = (first.q_icrf_body + 2.0 * (second.q_icrf_body + third.q_icrf_body) +
                      fourth.q_icrf_body) /
                     6.0,
      .rate_rad_s2 = (first.rate_rad_s2 + 2.0 * (second.rate_rad_s2 + third.rate_rad_s2) +
                      fourth.rate_rad_s2) /
                     6.0};
  BodyState end = changed(state, mean, step_s);
  end.q_icrf_body.normalize();
  return end;
}

Expected<void> check_step(double step_s, double rate_rad_s) {
  // Written so that NaN fails.
  if (!(step_s > 0.0)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration, fmt::format("a step of {} s: must be above 0", step_s)}};
  }
  if (!(step_s * rate_rad_s <= kMostTurn_rad)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("a step of {} s is too coarse for a body that turns by {:.4g} rad/s: must not "
                     "be above {:.4g} s, in which it turns by {} rad",
                     step_s, rate_rad_s, kMostTurn_rad / rate_rad_s, kMostTurn_rad)}};
  }
  return {};
}

}  // namespace spindrift
