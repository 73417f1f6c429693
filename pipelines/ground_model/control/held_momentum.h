/// @file
/// Wheels that are not commanded.

#pragma once

#include <Eigen/Core>

#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

/// Wheels that give no torque and keep their momentum, which is zero for a body without wheels.
struct HeldMomentum {
  Eigen::Vector3d wheels_body_nms = Eigen::Vector3d::Zero();

  static void command(const Eigen::Vector3d& /*torque_body_nm*/, double /*period_s*/) {}
  BodyTorques step(double /*step_s*/) const { return {.wheels_nms = wheels_body_nms}; }
  const Eigen::Vector3d& momentum_body_nms() const { return wheels_body_nms; }
};

}  // namespace spindrift
