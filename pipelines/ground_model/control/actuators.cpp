#include "pipelines/ground_model/control/actuators.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pipelines/ground_model/control/saturation.h"

namespace spindrift {

Wheels::Wheels(const WheelDesign& design)
    : design_{design},
      axes_body_{design.axes_body.colwise().normalized()},
      shares_{axes_body_.transpose() *
              Eigen::Matrix3d{axes_body_ * axes_body_.transpose()}.inverse()},
      momenta_nms_{WheelVector::Zero(design.axes_body.cols())},
      told_rad_s_{momenta_nms_},
      torques_nm_{momenta_nms_} {}

Expected<Wheels> Wheels::make(const WheelDesign& design) {
  constexpr double kFlat = 1e-6;
  const double shortest =
      design.axes_body.cols() > 0 ? design.axes_body.colwise().norm().minCoeff() : 0.0;
  // Written so that NaN fails.
  if (!(design.inertia_kg_m2 > 0.0 && design.torque_nm_most > 0.0 &&
        design.speed_rad_s_most > 0.0 && shortest > 0.0)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format(
             "{} wheels of {} kg m2, at most {} N m and {} rad/s, the shortest axis {} long: "
             "must be above 0",
             design.axes_body.cols(), design.inertia_kg_m2, design.torque_nm_most,
             design.speed_rad_s_most, shortest)}};
  }
  const Eigen::Matrix3Xd axes = design.axes_body.colwise().normalized();
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{axes * axes.transpose()}.eigenvalues();
  if (!(spread[0] > kFlat)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("the axes of {} wheels do not span space (least spread {:.3g}): there is a "
                     "direction about which they give no torque",
                     axes.cols(), spread[0])}};
  }
  return Wheels{design};
}

void Wheels::command(const Eigen::Vector3d& torque_body_nm, double period_s) {
  const WheelVector wanted_nm =
      within_largest(WheelVector{shares_ * torque_body_nm}, design_.torque_nm_most);
  told_rad_s_ = ((momenta_nms_ - period_s * wanted_nm) / design_.inertia_kg_m2)
                    .cwiseMin(design_.speed_rad_s_most)
                    .cwiseMax(-design_.speed_rad_s_most);
  torques_nm_ = (momenta_nms_ - design_.inertia_kg_m2 * told_rad_s_) / period_s;
}

BodyTorques Wheels::step(double step_s) {
  BodyTorques torques{.wheels_nm = axes_body_ * torques_nm_,
                      .wheels_nms = axes_body_ * momenta_nms_};
  momenta_nms_ -= step_s * torques_nm_;
  return torques;
}

Expected<Thrusters> Thrusters::make(const ThrusterDesign& design) {
  // Written so that NaN fails.
  if (!(design.torque_nm > 0.0 && design.shortest_s > 0.0 &&
        design.longest_s >= design.shortest_s)) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("thrusters of {} N m with pulses from {} to {} s: must be above 0, in order",
                     design.torque_nm, design.shortest_s, design.longest_s)}};
  }
  return Thrusters{design};
}

void Thrusters::command(const Eigen::Vector3d& torque_body_nm, double period_s) {
  const double longest_s = std::min(design_.longest_s, period_s);
  left_s_ = torque_body_nm.unaryExpr([&](double wanted_nm) {
    const double on_s = std::min(std::abs(wanted_nm) / design_.torque_nm * period_s, longest_s);
    return on_s < design_.shortest_s ? 0.0 : std::copysign(on_s, wanted_nm);
  });
}

BodyTorques Thrusters::step(double step_s) {
  const Eigen::Vector3d on_s = left_s_.cwiseMin(step_s).cwiseMax(-step_s);
  left_s_ -= on_s;
  return {.external_nm = design_.torque_nm / step_s * on_s};
}

}  // namespace spindrift
