/// @file
/// Closed loop of a body, its actuators and its disturbances: the laws command a torque once per
/// control period, and the body is integrated in steps of a fraction of the period.

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/control/actuators.h"
#include "pipelines/ground_model/control/control_laws.h"
#include "pipelines/ground_model/dynamics/disturbances.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"

namespace spindrift {

using Actuators = std::variant<Thrusters, Wheels, HeldMomentum>;

inline Eigen::Vector3d wheels_body_nms(const Actuators& actuators) {
  return std::visit([](const auto& is) -> Eigen::Vector3d { return is.momentum_body_nms(); },
                    actuators);
}

/// Simulates the closed loop.
/// @tparam Body BodyMotion where the whole motion is needed later, or SteppedBody.
template <class Body>
class ClosedLoop {
 public:
  /// @param steps Integration steps per control period; at least one.
  ClosedLoop(Body body, Actuators actuators, Disturbances disturbances, int steps)
      : body_{std::move(body)},
        actuators_{std::move(actuators)},
        disturbances_{std::move(disturbances)},
        steps_{steps} {}

  const Body& body() const& { return body_; }
  Body body() && { return std::move(body_); }
  const Actuators& actuators() const { return actuators_; }
  double period_s() const { return steps_ * body_.step_s(); }
  /// Returns the time since the start at which the next period begins.
  double t_s() const { return static_cast<double>(periods_) * period_s(); }

  /// Returns what sensors without errors measure now.
  MeasuredBody measured(const Eigen::Vector3d& sun_icrf) const {
    const BodyState& now = body_.last();
    return {
        .q_icrf_body = now.q_icrf_body,
        .rate_body_rad_s = now.rate_body_rad_s,
        .momentum_body_nms = body_.body().inertia_kg_m2() * now.rate_body_rad_s + wheels_body_nms(),
        .sun_body = now.q_icrf_body.conjugate() * sun_icrf};
  }

  Eigen::Vector3d wheels_body_nms() const { return spindrift::wheels_body_nms(actuators_); }

  /// Reserves memory so that no step up to `end_s` allocates.
  void reserve(double end_s) {
    if constexpr (requires { body_.reserve(std::size_t{}); }) {
      body_.reserve(static_cast<std::size_t>(std::ceil(end_s / period_s())) *
                    static_cast<std::size_t>(steps_));
    }
  }

  /// Simulates one control period. @param torque_body_nm Torque commanded by the law.
  void fly(const Eigen::Vector3d& torque_body_nm, const Surroundings& surroundings) {
    std::visit([&](auto& is) { is.command(torque_body_nm, period_s()); }, actuators_);
    for (int i = 0; i < steps_; ++i) {
      BodyTorques torques =
          std::visit([&](auto& is) { return is.step(body_.step_s()); }, actuators_);
      torques.external_nm += disturbance_now_nm(surroundings, t_s() + (i + 0.5) * body_.step_s());
      body_.step(torques);
    }
    ++periods_;
  }

 private:
  /// Returns the disturbance torque at the attitude of the middle of the step.
  Eigen::Vector3d disturbance_now_nm(const Surroundings& surroundings, double middle_s) const {
    const BodyState& now = body_.last();
    const Eigen::Quaterniond q_icrf_body =
        now.q_icrf_body * quaternion_by(0.5 * body_.step_s() * now.rate_body_rad_s);
    return disturbance_body_nm(disturbances_, body_.body().inertia_kg_m2(), surroundings,
                               q_icrf_body, middle_s);
  }

  Body body_;
  Actuators actuators_;
  Disturbances disturbances_;
  int steps_;
  std::int64_t periods_ = 0;
};

}  // namespace spindrift
