/// @file
/// Reaction wheels that are told speeds: Zhang 2019, eq. 16 to 20.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

inline constexpr int kMostWheels = 8;
using WheelAxes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostWheels>;
using WheelVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostWheels, 1>;

/// All alike.
struct WheelDesign {
  WheelAxes axes_body;   ///< A column a wheel, any length.
  double inertia_kg_m2;  ///< About the axis of a wheel.
  double torque_nm_most;
  double speed_rad_s_most;  ///< That they are told: a margin to what they stand is in it.
};

/// At rest at first. The torque asked for is shared out so that the sum of squares is least, and
/// made smaller along its direction until each wheel can give it. A wheel is told the speed of the
/// end of the period and reaches it evenly; none is told more than it can.
class Wheels {
 public:
  /// @return InvalidConfiguration where the axes do not span space, or a number is not positive.
  static Expected<Wheels> make(const WheelDesign& design);

  void command(const Eigen::Vector3d& torque_body_nm, double period_s);

  /// On by a step. @return On the body in this step.
  BodyTorques step(double step_s);

  Eigen::Vector3d momentum_body_nms() const { return axes_body_ * momenta_nms_; }
  /// Of each wheel, about its axis.
  const WheelVector& momenta_nms() const { return momenta_nms_; }
  WheelVector speeds_rad_s() const { return momenta_nms_ / design_.inertia_kg_m2; }
  /// What the wheels were told last.
  const WheelVector& told_rad_s() const { return told_rad_s_; }

 private:
  explicit Wheels(const WheelDesign& design);

  WheelDesign design_;
  WheelAxes axes_body_;  ///< Unit.
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMostWheels, 3> shares_;
  WheelVector momenta_nms_;
  WheelVector told_rad_s_;
  WheelVector torques_nm_;  ///< On the body.
};

}  // namespace spindrift
