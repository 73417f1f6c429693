/// @file
/// Motion of a rigid body under torques that are constant over each step, whatever produced them.

#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

class BodyMotion {
 public:
  BodyMotion(RigidBody body, const BodyState& start, double step_s)
      : body_{std::move(body)}, step_s_{step_s}, states_{start} {}

  /// Reserves memory so that the next `steps` steps do not allocate.
  void reserve(std::size_t steps) {
    states_.reserve(states_.size() + steps);
    torques_.reserve(torques_.size() + steps);
  }

  void step(const BodyTorques& torques) {
    states_.push_back(body_.after(states_.back(), torques, step_s_));
    torques_.push_back(torques);
  }

  const RigidBody& body() const { return body_; }
  const BodyState& last() const { return states_.back(); }
  double step_s() const { return step_s_; }
  double end_s() const { return step_s_ * static_cast<double>(torques_.size()); }

  /// Returns the state at `t_s`. Before the start it is extrapolated backwards with the first
  /// torques; after the end it is the last state.
  BodyState at(double t_s) const {
    const std::size_t step = t_s > 0.0 ? static_cast<std::size_t>(t_s / step_s_) : 0;
    return step < torques_.size() ? body_.after(states_[step], torques_[step],
                                                t_s - step_s_ * static_cast<double>(step))
                                  : states_.back();
  }

 private:
  RigidBody body_;
  double step_s_;
  std::vector<BodyState> states_;
  std::vector<BodyTorques> torques_;  ///< Torques of the step that follows each state but the last.
};

}  // namespace spindrift
