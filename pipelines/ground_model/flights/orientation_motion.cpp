#include "pipelines/ground_model/flights/orientation_motion.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/flights/channel_margins.h"
#include "pipelines/ground_model/sensors/three_axis_reading.h"

namespace spindrift {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

Eigen::Quaterniond q_icrf_target(const OrientationTruth& truth) {
  return truth.body.at_start.q_icrf_body * truth.control.q_start_target;
}

PointingLaw pointing_law(const OrientationTruth& truth) {
  const OrientationControl& control = truth.control;
  const AttitudeTarget target{.q_icrf_target = q_icrf_target(truth)};
  if (control.variable_limit) {
    return VariableLimitPd{.target = target,
                           .gains = control.gains(),
                           .moments_kg_m2 = control.moments_kg_m2,
                           .torque_nm_most = control.wheels.torque_nm_most,
                           .rate_rad_s_most = Vector3d::Constant(control.slew_rad_s)};
  }
  // This is kd / kp, which is the same for each axis.
  const double rate_s = control.damping / control.frequency_rad_s;
  return SaturatedPd{.target = target,
                     .gains = control.gains(),
                     .error_most = std::min(1.0, rate_s * control.slew_rad_s)};
}

/// Models what the computer on board takes as measured.
class OnBoard {
 public:
  OnBoard(const OrientationTruth& truth, const std::optional<TrueGyro>& gyro, Chance& chance)
      : control_{truth.control},
        gyro_{gyro},
        chance_{chance},
        q_icrf_body_{truth.body.at_start.q_icrf_body} {}

  MeasuredBody measured(const ClosedLoop<BodyMotion>& loop) {
    // No law of this manoeuvre uses the direction of the Sun.
    MeasuredBody now = loop.measured(Vector3d::UnitX());
    if (!control_.by_gyro) {
      return now;
    }
    now.rate_body_rad_s = gyro_reading(
        now.rate_body_rad_s, gyro_->bias_rad_s + chance_.normal_vector(gyro_->noise_rad_s),
        gyro_->range_rad_s);
    if (rate_rad_s_) {
      q_icrf_body_ = propagated(
          *control_.by_gyro, q_icrf_body_,
          {.dt_s = loop.period_s(), .from_rad_s = *rate_rad_s_, .to_rad_s = now.rate_body_rad_s});
    }
    rate_rad_s_ = now.rate_body_rad_s;
    now.q_icrf_body = q_icrf_body_;
    now.momentum_body_nms =
        control_.moments_kg_m2.cwiseProduct(now.rate_body_rad_s) + loop.wheels_body_nms();
    return now;
  }

 private:
  const OrientationControl& control_;
  const std::optional<TrueGyro>& gyro_;
  Chance& chance_;
  Eigen::Quaterniond q_icrf_body_;
  std::optional<Vector3d> rate_rad_s_;  ///< Rate read in the period before; empty: none yet.
};

/// Delays the commanded torque by a number of periods.
class LateTorque {
 public:
  explicit LateTorque(int periods)
      : asked_nm_(static_cast<std::size_t>(periods), Vector3d::Zero()) {}

  Vector3d after(const Vector3d& now_nm) {
    asked_nm_.push_back(now_nm);
    Vector3d due_nm = asked_nm_.front();
    asked_nm_.pop_front();
    return due_nm;
  }

 private:
  std::deque<Vector3d> asked_nm_;
};

ControlRecord record_of(const ClosedLoop<BodyMotion>& loop, ControlMode mode) {
  const auto& wheels = std::get<Wheels>(loop.actuators());
  return {.t_s = loop.t_s(),
          .mode = mode,
          .momenta_nms = wheels.momenta_nms(),
          .speeds_rad_s = wheels.speeds_rad_s(),
          .told_rad_s = wheels.told_rad_s()};
}

/// Returns twice dq/dt. @param q Quaternion in the order x, y, z, w.
Vector4d twice_change(const Vector4d& q, const Vector3d& rate_rad_s) {
  Quaterniond rate{0.0, 0.0, 0.0, 0.0};
  rate.vec() = rate_rad_s;
  return (Quaterniond{q} * rate).coeffs();
}

Quaterniond runge_kutta(const Quaterniond& q_icrf_body, const RateSpan& span) {
  const double h_s = span.dt_s;
  const Vector4d& q = q_icrf_body.coeffs();
  const Vector3d middle_rad_s = 0.5 * (span.from_rad_s + span.to_rad_s);
  const Vector4d first = twice_change(q, span.from_rad_s);
  const Vector4d second = twice_change(q + 0.25 * h_s * first, middle_rad_s);
  const Vector4d third = twice_change(q + 0.25 * h_s * second, middle_rad_s);
  const Vector4d fourth = twice_change(q + 0.5 * h_s * third, span.to_rad_s);
  return Quaterniond{Vector4d{q + h_s / 12.0 * (first + 2.0 * (second + third) + fourth)}}
      .normalized();
}

}  // namespace

Quaterniond propagated(GyroPropagation by, const Quaterniond& q_icrf_body, const RateSpan& span) {
  switch (by) {
    case GyroPropagation::Composition:
      return (q_icrf_body * quaternion_by(turned_rad(span, Vector3d::Zero()))).normalized();
    case GyroPropagation::RungeKutta:
      return runge_kutta(q_icrf_body, span);
  }
  return q_icrf_body;
}

Expected<Orientation> orientation_motion(const OrientationTruth& truth,
                                         const std::optional<TrueGyro>& gyro, const Orbit& orbit,
                                         Chance& chance) {
  const OrientationControl& control = truth.control;
  if (auto good = check_margins(truth); !good) {
    return Unexpected{std::move(good.error())};
  }
  const auto wheels = Wheels::make(control.wheels);
  if (!wheels) {
    return Unexpected{wheels.error()};
  }
  auto laws = AttitudeControl::make(control.plan, RateFeedback{.gain_nms = control.gains().kd_nms},
                                    pointing_law(truth));
  if (!laws) {
    return Unexpected{std::move(laws.error())};
  }
  auto loop = loop_of(truth.body, *wheels, control.period_s);
  if (!loop) {
    return Unexpected{std::move(loop.error())};
  }
  OnBoard on_board{truth, gyro, chance};
  LateTorque late{control.periods_late};
  std::vector<ControlRecord> record;
  record.reserve(static_cast<std::size_t>(truth.body.end_s / control.period_s) + 2);
  return fly(*loop, truth.body, orbit,
             [&](TaiTime, const OrbitState&) {
               const Vector3d asked_nm =
                   laws->torque_body_nm(loop->t_s(), on_board.measured(*loop));
               record.push_back(record_of(*loop, laws->mode()));
               return late.after(asked_nm);
             })
      .map([&] {
        record.push_back(record_of(*loop, laws->mode()));
        return Orientation{.motion = std::move(*loop).body(), .record = std::move(record)};
      });
}

OrientationOutcome outcome_of(const Orientation& orientation, const OrientationTruth& truth) {
  const Eigen::Quaterniond target = q_icrf_target(truth);
  OrientationOutcome outcome{.pointing_s = std::nullopt,
                             .settled_s = std::nullopt,
                             .last_off_rad = 0.0,
                             .most_nms = 0.0,
                             .most_rad_s = 0.0};
  for (const ControlRecord& now : orientation.record) {
    if (now.mode == ControlMode::Pointing && !outcome.pointing_s) {
      outcome.pointing_s = now.t_s;
    }
    outcome.last_off_rad = angle_between_rad(orientation.motion.at(now.t_s).q_icrf_body, target);
    if (outcome.last_off_rad > kRadPerDeg) {
      outcome.settled_s.reset();
    } else if (!outcome.settled_s) {
      outcome.settled_s = now.t_s;
    }
    outcome.most_nms = std::max(outcome.most_nms, now.momenta_nms.lpNorm<Eigen::Infinity>());
    outcome.most_rad_s = std::max(outcome.most_rad_s, now.speeds_rad_s.lpNorm<Eigen::Infinity>());
  }
  return outcome;
}

}  // namespace spindrift
