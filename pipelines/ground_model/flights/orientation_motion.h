/// @file
/// Motion of a body that turns to an attitude by its wheels (Zhang 2019): it drifts without
/// control, its rates are damped, then it points. Its computer may integrate the attitude from its
/// gyro.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/actuators.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/flights/body_flight.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"
#include "pipelines/three_axis/mekf.h"

namespace spindrift {

/// Propagation of an attitude by the gyro in an on-board computer. The ground always composes
/// rotations (mekf.h, rate_track.h); Runge-Kutta is for a spacecraft whose computer uses it.
enum class GyroPropagation {
  /// Composes the turn of the span by the Magnus series: exact about a fixed axis.
  Composition,
  /// Integrates by fourth-order Runge-Kutta with the rates at both ends and their mean for the
  /// middle (seed 004, eq. 5 to 10). For a turn by x rad per step about a fixed axis its error is
  /// x^5 / 1920 rad: 3e-9 where x is a tenth, 3e-14 where it is a hundredth.
  RungeKutta,
};

/// Propagates the attitude over a span. Both methods take the rate as linear between the samples.
/// Where it is not, both have the same error, dt^3 / 12 of the second derivative of the rate, which
/// mostly exceeds the error of Runge-Kutta.
Eigen::Quaterniond propagated(GyroPropagation by, const Eigen::Quaterniond& q_icrf_body,
                              const RateSpan& span);

struct OrientationControl {
  ControlPlan plan;
  /// Target attitude relative to the body's attitude at the start.
  Eigen::Quaterniond q_start_target;
  WheelDesign wheels;
  Eigen::Vector3d moments_kg_m2;  ///< Moments assumed for the gains and the gyroscopic torque.
  double frequency_rad_s;         ///< Natural frequency about each axis for small angles;
  double damping;
  double slew_rad_s;    ///< Largest rate of the turn about an axis.
  bool variable_limit;  ///< True: VariableLimitPd instead of SaturatedPd.
  double period_s;
  int periods_late;  ///< Delay of the commanded torque, in periods.
  /// Propagation of the attitude on board; empty: the laws know the true rate and attitude.
  std::optional<GyroPropagation> by_gyro;

  PdGains gains() const { return PdGains::of(moments_kg_m2, frequency_rad_s, damping); }
};

struct OrientationTruth {
  BodyTruth body;
  OrientationControl control;
};

/// State of control at the beginning of a period.
struct ControlRecord {
  double t_s;  ///< Time since the start.
  ControlMode mode;
  WheelVector momenta_nms;
  WheelVector speeds_rad_s;
  WheelVector told_rad_s;  ///< Speeds commanded for the end of the period before.
};

struct Orientation {
  BodyMotion motion;
  std::vector<ControlRecord> record;  ///< Records of each period, and of the end.
};

/// Simulates the motion.
/// @param gyro Gyro read on board once a period, with noise of its own draws; needed with
///        `by_gyro`.
/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia, wheels or times, a period too long for the loop, and a body too fast
///         for the step.
Expected<Orientation> orientation_motion(const OrientationTruth& truth,
                                         const std::optional<TrueGyro>& gyro, const Orbit& orbit,
                                         Chance& chance);

/// Result of the manoeuvre.
struct OrientationOutcome {
  std::optional<double> pointing_s;  ///< Start of pointing, since the start; empty: never.
  /// Time since which it stays within a degree of the target; empty: never.
  std::optional<double> settled_s;
  double last_off_rad;  ///< Angle to the target at the end.
  double most_nms;      ///< Largest momentum of a wheel.
  double most_rad_s;    ///< Largest speed of a wheel.
};

OrientationOutcome outcome_of(const Orientation& orientation, const OrientationTruth& truth);

}  // namespace spindrift
