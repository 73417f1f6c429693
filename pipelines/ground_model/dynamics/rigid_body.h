/// @file
/// A rigid body under torques:
///
///     dq/dt = 1/2 q (w, 0),    I dw/dt = torque - w x I w

#pragma once

#include <Eigen/Core>

#include "pipelines/frames/body_state.h"

namespace spindrift {

class RigidBody {
 public:
  /// @param inertia_kg_m2 About the centre of mass, body axes: symmetric, positive definite.
  explicit RigidBody(const Eigen::Matrix3d& inertia_kg_m2)
      : inertia_kg_m2_{inertia_kg_m2},
        inverse_{inertia_kg_m2.ldlt().solve(Eigen::Matrix3d::Identity())} {}

  const Eigen::Matrix3d& inertia_kg_m2() const { return inertia_kg_m2_; }

  Eigen::Vector3d acceleration_rad_s2(const Eigen::Vector3d& rate_body_rad_s,
                                      const Eigen::Vector3d& torque_body_nm) const {
    return inverse_ * (torque_body_nm - rate_body_rad_s.cross(inertia_kg_m2_ * rate_body_rad_s));
  }

  /// One step of Runge-Kutta of fourth order: good to 1e-11 rad where it turns by a hundredth of a
  /// radian.
  /// @param torque_body_nm Even in body axes.
  BodyState after(const BodyState& state, const Eigen::Vector3d& torque_body_nm,
                  double step_s) const;

 private:
  Eigen::Matrix3d inertia_kg_m2_;
  Eigen::Matrix3d inverse_;
};

}  // namespace spindrift
