#include "pipelines/ground_model/control/attitude_control.h"

#include <fmt/format.h>

namespace spindrift {
namespace {

using Eigen::Vector3d;

template <class... Laws>
Vector3d torque_of(const std::variant<Laws...>& law, const MeasuredBody& measured) {
  return std::visit([&](const auto& is) { return is.torque_body_nm(measured); }, law);
}

}  // namespace

Expected<AttitudeControl> AttitudeControl::make(const ControlPlan& plan, const DampingLaw& damping,
                                                const PointingLaw& pointing) {
  // Written so that NaN fails.
  if (!(plan.control_on_s >= 0.0 && plan.pointing_at_s >= plan.control_on_s &&
        plan.damped_rad_s >= 0.0)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("control is on at {} s, damps below {} rad/s and points at {} s: must not be "
                     "negative, and the times in order",
                     plan.control_on_s, plan.damped_rad_s, plan.pointing_at_s)}};
  }
  return AttitudeControl{plan, damping, pointing};
}

Vector3d AttitudeControl::torque_body_nm(double t_s, const MeasuredBody& measured) {
  // Tolerance so that a multiple of the period is not taken for the period before by rounding.
  const double now_s = t_s + 1e-6;
  if (mode_ == ControlMode::Drift && now_s >= plan_.control_on_s) {
    mode_ = ControlMode::Damping;
  }
  if (mode_ == ControlMode::Damping &&
      (now_s >= plan_.pointing_at_s ||
       measured.rate_body_rad_s.lpNorm<Eigen::Infinity>() < plan_.damped_rad_s)) {
    mode_ = ControlMode::Pointing;
  }
  switch (mode_) {
    case ControlMode::Drift:
      return Vector3d::Zero();
    case ControlMode::Damping:
      return torque_of(damping_, measured);
    case ControlMode::Pointing:
      return torque_of(pointing_, measured);
  }
  return Vector3d::Zero();
}

}  // namespace spindrift
