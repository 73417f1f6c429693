/// @file
/// What turns a body: reaction wheels that are commanded by speed (Zhang 2019, eq. 16 to 20),
/// wheels that are not commanded, and pairs of on-off thrusters about each body axis.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

/// Wheels that give no torque and keep their momentum, which is zero for a body without wheels.
struct HeldMomentum {
  Eigen::Vector3d wheels_body_nms = Eigen::Vector3d::Zero();

  static void command(const Eigen::Vector3d& /*torque_body_nm*/, double /*period_s*/) {}
  BodyTorques step(double /*step_s*/) const { return {.wheels_nms = wheels_body_nms}; }
  const Eigen::Vector3d& momentum_body_nms() const { return wheels_body_nms; }
};

inline constexpr int kMostWheels = 8;
using WheelAxes = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostWheels>;
using WheelVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostWheels, 1>;

/// Design of a set of identical wheels.
struct WheelDesign {
  WheelAxes axes_body;   ///< One column per wheel, of any length.
  double inertia_kg_m2;  ///< Moment of inertia of a wheel about its spin axis.
  double torque_nm_most;
  /// Limit of the commanded speed, including a margin to what the wheels stand.
  double speed_rad_s_most;
};

/// Wheels that start at rest. The commanded torque is distributed so that the sum of squares is
/// least, and scaled down along its direction until each wheel can give it. Each wheel is commanded
/// the speed at the end of the period, up to its limit, and reaches it at constant torque.
class Wheels {
 public:
  /// @return InvalidConfiguration where the axes do not span space, or a number is not positive.
  static Expected<Wheels> make(const WheelDesign& design);

  void command(const Eigen::Vector3d& torque_body_nm, double period_s);

  /// Simulates one step. @return Torques on the body in this step.
  BodyTorques step(double step_s);

  Eigen::Vector3d momentum_body_nms() const { return axes_body_ * momenta_nms_; }
  /// Returns the momentum of each wheel about its axis.
  const WheelVector& momenta_nms() const { return momenta_nms_; }
  WheelVector speeds_rad_s() const { return momenta_nms_ / design_.inertia_kg_m2; }
  /// Returns the speeds last commanded.
  const WheelVector& told_rad_s() const { return told_rad_s_; }

 private:
  explicit Wheels(const WheelDesign& design);

  WheelDesign design_;
  WheelAxes axes_body_;  ///< Unit vectors of the spin axes.
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, kMostWheels, 3> shares_;
  WheelVector momenta_nms_;
  WheelVector told_rad_s_;
  WheelVector torques_nm_;  ///< Torque of each wheel on the body.
};

struct ThrusterDesign {
  double torque_nm;   ///< Torque about each axis, in either direction.
  double shortest_s;  ///< Shortest pulse.
  double longest_s;
};

/// Fires one pulse per control period and axis, from the start of the period on and as long as
/// gives the commanded impulse, or none where that is shorter than the shortest pulse. A pulse that
/// ends within a step counts as its mean over the step.
class Thrusters {
 public:
  /// @return InvalidConfiguration where a number is not positive, or no pulse is long enough.
  static Expected<Thrusters> make(const ThrusterDesign& design);

  void command(const Eigen::Vector3d& torque_body_nm, double period_s);

  /// Simulates one step. @return Torques on the body in this step.
  BodyTorques step(double step_s);

  static Eigen::Vector3d momentum_body_nms() { return Eigen::Vector3d::Zero(); }

 private:
  explicit Thrusters(const ThrusterDesign& design) : design_{design} {}

  ThrusterDesign design_;
  /// Remaining on-time about each axis; negative: reverse torque.
  Eigen::Vector3d left_s_ = Eigen::Vector3d::Zero();
};

}  // namespace spindrift
