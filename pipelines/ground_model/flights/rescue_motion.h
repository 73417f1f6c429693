/// @file
/// Motion of a lost body that its magnetometer alone brings back (Huang 2009, seed 001): gyro and
/// Earth sensor fail, what the computer then believes turns the body away, the lost gate opens and
/// control stops, a bank of filters finds the attitude from nothing, and when the safe gate opens
/// thruster pulses turn the body to the commanded attitude, until that is reached.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/control/actuators.h"
#include "pipelines/ground_model/control/control_laws.h"
#include "pipelines/ground_model/flights/body_flight.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/three_axis/unscented/gukf.h"

namespace spindrift {

enum class RescuePhase {
  Pointing,    ///< By gyro and Earth sensor, whether they are right or not.
  Lost,        ///< Control is off.
  Controlled,  ///< The filter's attitude controls the body.
  Reached,     ///< The body is at the commanded attitude.
};

/// Failure of gyro and Earth sensor, after which the computer takes the body to turn while it does
/// not.
struct SensorFailure {
  double t_s;                   ///< Time since the start.
  Eigen::Vector3d turns_rad_s;  ///< Measured minus true rate from then on, body axes.
};

struct RescueControl {
  NominalAttitude commanded;
  /// Empty: nothing points the body before it is declared lost.
  std::optional<SensorFailure> failure;
  ThrusterDesign thrusters;
  Eigen::Vector3d moments_kg_m2;  ///< Moments assumed for the gains.
  double frequency_rad_s;         ///< Natural frequency about each axis for small angles;
  double damping;
  double slew_rad_s;  ///< Largest rate of the turn about an axis.
  double period_s;    ///< Period of control and of the fields that the computer uses.
};

struct RescueTruth {
  BodyTruth body;
  TrueMagnetometer magnetometer;  ///< Read on board once a period, with draws of its own.
  RescueControl control;
  GukfModel filter;
};

/// State at the beginning of a period.
struct RescueRecord {
  double t_s;  ///< Time since the start.
  RescuePhase phase;
  Eigen::Vector3d torque_nm;  ///< Torque commanded for the period.
  double off_rad;             ///< Angle of the body to the commanded attitude.
  /// Angle of the most likely filter to the body; empty without a filter.
  std::optional<double> error_rad;
};

struct Rescue {
  BodyMotion motion;
  std::vector<RescueRecord> record;
};

/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia or thrusters, and a body too fast for the step.
Expected<Rescue> rescue_motion(const RescueTruth& truth, const Orbit& orbit, Chance& chance);

/// Times since the start at which the phases began for the first time; empty: never.
struct RescueOutcome {
  std::optional<double> lost_s;
  std::optional<double> controlled_s;
  std::optional<double> reached_s;
  double last_off_rad;                      ///< Angle to the commanded attitude at the end.
  std::optional<double> error_at_safe_rad;  ///< Error of the filter when control began.
};

RescueOutcome outcome_of(const Rescue& rescue);

}  // namespace spindrift
