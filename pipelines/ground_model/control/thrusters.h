/// @file
/// Pairs of on-off thrusters about each body axis.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

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
