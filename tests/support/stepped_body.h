/// @file
/// Motion of a rigid body that keeps only its latest state, unlike BodyMotion.

#pragma once

#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

class SteppedBody {
 public:
  SteppedBody(const RigidBody& body, const BodyState& start, double step_s)
      : body_{body}, step_s_{step_s}, now_{start} {}

  void step(const BodyTorques& torques) { now_ = body_.after(now_, torques, step_s_); }

  const RigidBody& body() const { return body_; }
  const BodyState& last() const { return now_; }
  double step_s() const { return step_s_; }

 private:
  RigidBody body_;
  double step_s_;
  BodyState now_;
};

}  // namespace spindrift
