/// @file
/// Pairs of thrusters about each body axis, which are on or off.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

struct ThrusterDesign {
  double torque_nm;   ///< About each axis, either way.
  double shortest_s;  ///< Of a pulse.
  double longest_s;
};

/// A pulse a period and axis, from its start on, as long as gives the impulse asked for: none where
/// that is shorter than the shortest. A pulse that ends within a step counts as its mean over it.
class Thrusters {
 public:
  /// @return InvalidConfiguration where a number is not positive, or no pulse is long enough.
  static Expected<Thrusters> make(const ThrusterDesign& design);

  void command(const Eigen::Vector3d& torque_body_nm, double period_s);

  /// On by a step. @return On the body in this step.
  BodyTorques step(double step_s);

  /// They hold none.
  static Eigen::Vector3d momentum_body_nms() { return Eigen::Vector3d::Zero(); }

 private:
  explicit Thrusters(const ThrusterDesign& design) : design_{design} {}

  ThrusterDesign design_;
  Eigen::Vector3d left_s_ = Eigen::Vector3d::Zero();  ///< On about each axis; negative: backwards.
};

}  // namespace spindrift
