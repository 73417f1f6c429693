#include "pipelines/ground_model/control/control_laws.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/control/saturation.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

/// Attitude and rate error of the body with respect to the target, body axes.
struct AttitudeError {
  Vector3d quaternion;  ///< Vector part of the error; its scalar part is not negative.
  Vector3d rate_rad_s;
};

AttitudeError error_of(const AttitudeTarget& target, const MeasuredBody& measured) {
  const Eigen::Quaterniond q_target_body = target.q_icrf_target.conjugate() * measured.q_icrf_body;
  return {
      .quaternion = q_target_body.w() < 0.0 ? Vector3d{-q_target_body.vec()} : q_target_body.vec(),
      .rate_rad_s =
          measured.rate_body_rad_s - q_target_body.conjugate() * target.rate_target_rad_s};
}

Vector3d wanted_rate_rad_s(const SunAcquisition& law, const Vector3d& sun_body) {
  constexpr double kPerRadian_1_s = 0.1;
  const double angle_rad = angle_between_rad(-Vector3d::UnitZ(), sun_body);
  // With the Sun opposite to -Z any axis across it will do.
  const Vector3d axis =
      (-Vector3d::UnitZ().cross(sun_body) + 1e-12 * Vector3d::UnitX()).normalized();
  const double braked_rad_s =
      std::sqrt(angle_rad * law.torque_nm_most / law.inertia_kg_m2.diagonal().maxCoeff());
  return std::min({law.slew_rad_s, braked_rad_s, angle_rad * kPerRadian_1_s}) * axis;
}

}  // namespace

Vector3d RateFeedback::torque_body_nm(const MeasuredBody& measured) const {
  return -gain_nms.cwiseProduct(measured.rate_body_rad_s);
}

Vector3d RelayDamping::torque_body_nm(const MeasuredBody& measured) const {
  return measured.rate_body_rad_s.unaryExpr([&](double rate_rad_s) {
    return std::abs(rate_rad_s) > dead_band_rad_s ? -std::copysign(torque_nm, rate_rad_s) : 0.0;
  });
}

Vector3d SunAcquisition::torque_body_nm(const MeasuredBody& measured) const {
  return inertia_kg_m2 * (wanted_rate_rad_s(*this, measured.sun_body) - measured.rate_body_rad_s) /
         period_s;
}

PdGains PdGains::of(const Vector3d& moments_kg_m2, double frequency_rad_s, double damping) {
  return {.kp_nm = 2.0 * frequency_rad_s * frequency_rad_s * moments_kg_m2,
          .kd_nms = 2.0 * damping * frequency_rad_s * moments_kg_m2};
}

Vector3d SaturatedPd::torque_body_nm(const MeasuredBody& measured) const {
  const AttitudeError error = error_of(target, measured);
  return -gains.kp_nm.cwiseProduct(within_largest(error.quaternion, error_most)) -
         gains.kd_nms.cwiseProduct(error.rate_rad_s) +
         measured.rate_body_rad_s.cross(measured.momentum_body_nms);
}

Vector3d VariableLimitPd::torque_body_nm(const MeasuredBody& measured) const {
  const AttitudeError error = error_of(target, measured);
  const Vector3d braked_rad_s =
      (4.0 * torque_nm_most * error.quaternion.cwiseAbs().cwiseQuotient(moments_kg_m2)).cwiseSqrt();
  const Vector3d limit =
      gains.kd_nms.cwiseQuotient(gains.kp_nm).cwiseProduct(braked_rad_s.cwiseMin(rate_rad_s_most));
  const Vector3d limited = error.quaternion.cwiseMin(limit).cwiseMax(-limit);
  return -within_length(
      gains.kp_nm.cwiseProduct(limited) + gains.kd_nms.cwiseProduct(error.rate_rad_s),
      torque_nm_most);
}

}  // namespace spindrift
