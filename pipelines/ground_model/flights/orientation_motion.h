/// @file
/// A body that turns to an attitude by its wheels (Zhang 2019): it slides out without control; its
/// rates are damped; from then on it points. Its computer may know the attitude from its gyro
/// alone, counted from the start.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/control/gyro_propagation.h"
#include "pipelines/ground_model/control/wheels.h"
#include "pipelines/ground_model/flights/body_flight.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"

namespace spindrift {

struct OrientationControl {
  ControlPlan plan;
  Eigen::Quaterniond q_start_target;  ///< Where to turn, seen from the body as it stands at first.
  WheelDesign wheels;
  Eigen::Vector3d moments_kg_m2;  ///< By which gains are chosen and the gyroscopic torque is known.
  double frequency_rad_s;         ///< Of small angles about each axis; and their damping.
  double damping;
  double slew_rad_s;    ///< Of the turn, at most about an axis.
  bool variable_limit;  ///< VariableLimitPd in place of SaturatedPd.
  double period_s;
  int periods_late;  ///< What is asked for comes so much later.
  /// Empty: the laws know rate and attitude as they are.
  std::optional<GyroPropagation> by_gyro;

  PdGains gains() const { return PdGains::of(moments_kg_m2, frequency_rad_s, damping); }
};

struct OrientationTruth {
  BodyTruth body;
  OrientationControl control;
};

/// At the beginning of a period.
struct ControlRecord {
  double t_s;  ///< Behind the start.
  ControlMode mode;
  WheelVector momenta_nms;
  WheelVector speeds_rad_s;
  WheelVector told_rad_s;  ///< For the end of the period before.
};

struct Orientation {
  BodyMotion motion;
  std::vector<ControlRecord> record;  ///< Of each period, and of the end.
};

/// @param gyro Of the computer on board, which reads it once a period, by draws of its own; it is
///             there where `by_gyro` is.
/// @return NoCoverage where the orbit or the field ends before; InvalidConfiguration for a body,
///         wheels or times that cannot be, a period that is too long for the loop, and a body that
///         turns too fast for the step.
Expected<Orientation> orientation_motion(const OrientationTruth& truth,
                                         const std::optional<TrueGyro>& gyro, const Orbit& orbit,
                                         Chance& chance);

/// What came of it.
struct OrientationOutcome {
  std::optional<double> pointing_s;  ///< Since when it points; empty: never. Behind the start.
  std::optional<double> settled_s;   ///< Since when it is within a degree of the target; likewise.
  double last_off_rad;               ///< From the target, in the end.
  double most_nms;                   ///< Of a wheel.
  double most_rad_s;                 ///< Of a wheel.
};

OrientationOutcome outcome_of(const Orientation& orientation, const OrientationTruth& truth);

}  // namespace spindrift
