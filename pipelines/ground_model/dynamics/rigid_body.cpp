#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {
namespace {

struct Change {
  Eigen::Vector4d q_icrf_body;  ///< x, y, z, w.
  Eigen::Vector3d rate_rad_s2;
};

Change change_of(const RigidBody& body, const BodyState& state,
                 const Eigen::Vector3d& torque_body_nm) {
  Eigen::Quaterniond rate{0.0, 0.0, 0.0, 0.0};
  rate.vec() = 0.5 * state.rate_body_rad_s;
  return {.q_icrf_body = (state.q_icrf_body * rate).coeffs(),
          .rate_rad_s2 = body.acceleration_rad_s2(state.rate_body_rad_s, torque_body_nm)};
}

BodyState changed(const BodyState& state, const Change& change, double step_s) {
  return {
      .q_icrf_body = Eigen::Quaterniond{state.q_icrf_body.coeffs() + step_s * change.q_icrf_body},
      .rate_body_rad_s = state.rate_body_rad_s + step_s * change.rate_rad_s2};
}

}  // namespace

BodyState RigidBody::after(const BodyState& state, const Eigen::Vector3d& torque_body_nm,
                           double step_s) const {
  const Change first = change_of(*this, state, torque_body_nm);
  const Change second = change_of(*this, changed(state, first, 0.5 * step_s), torque_body_nm);
  const Change third = change_of(*this, changed(state, second, 0.5 * step_s), torque_body_nm);
  const Change fourth = change_of(*this, changed(state, third, step_s), torque_body_nm);
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

}  // namespace spindrift
