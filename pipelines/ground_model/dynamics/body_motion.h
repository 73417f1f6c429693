/// @file
/// How a body turned under torques that are even for a step each: what sensors see, whoever made
/// the torques.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

class BodyMotion {
 public:
  BodyMotion(const RigidBody& body, const BodyState& start, double step_s)
      : body_{body}, step_s_{step_s}, states_{start} {}

  /// On by a step. @param torque_body_nm Even in body axes.
  void step(const Eigen::Vector3d& torque_body_nm) {
    states_.push_back(body_.after(states_.back(), torque_body_nm, step_s_));
    torques_body_nm_.push_back(torque_body_nm);
  }

  const RigidBody& body() const { return body_; }
  const BodyState& last() const { return states_.back(); }
  double end_s() const { return step_s_ * static_cast<double>(torques_body_nm_.size()); }

  /// @param t_s Behind the start; from the end on it is the last.
  BodyState at(double t_s) const {
    const auto step = static_cast<std::size_t>(t_s / step_s_);
    return step < torques_body_nm_.size() ? body_.after(states_[step], torques_body_nm_[step],
                                                        t_s - step_s_ * static_cast<double>(step))
                                          : states_.back();
  }

 private:
  RigidBody body_;
  double step_s_;
  std::vector<BodyState> states_;
  std::vector<Eigen::Vector3d> torques_body_nm_;  ///< Behind each state but the last.
};

}  // namespace spindrift
