/// @file
/// Simulated flights of three-axis spacecraft, and the telemetry that the ground sees of them.

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/ground_model/control/actuators.h"
#include "pipelines/ground_model/flights/body_flight.h"
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "pipelines/ground_model/flights/rescue_motion.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"

namespace spindrift {

struct TumblingTruth {
  BodyTruth body;
  Eigen::Vector3d wheels_body_nms = Eigen::Vector3d::Zero();  ///< Constant momentum of the wheels.
};

/// Simulates the motion of an uncontrolled body: free rotation under disturbance torques, in steps
/// of at most 1 s, and of at most 0.01 rad at the rate of the start.
/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia, and for a body that comes to turn too fast for the step.
Expected<BodyMotion> tumbling_motion(const TumblingTruth& truth, const Orbit& orbit);

struct SeparationControl {
  ThrusterDesign thrusters;
  double dead_band_rad_s;  ///< Rate about an axis up to which its relay is off.
  double slew_rad_s;       ///< Largest rate of the turn to the Sun.
  /// Control period.
  double period_s = 0.05;
};

struct SeparationTruth {
  BodyTruth body;  ///< Body from T1, the start.
  SeparationControl control;
  double control_on_s;   ///< T2: start of rate damping, since the start.
  double acquisition_s;  ///< T3: start of Sun acquisition; not before T2.
};

/// Simulates the motion of a body from separation from the launcher until it points at the Sun: it
/// drifts without control, relays damp its rates, then -Z turns to the Sun and stays there. The
/// laws know the true rate and Sun.
/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia, thrusters or times, and a body too fast for the period.
Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit);

/// Sensors of a body, and the faults of what the ground receives from them.
struct ThreeAxisView {
  std::uint64_t seed;
  ThreeAxisSensors sensors;                   ///< Sensors; the gyro bias is drawn
  double bias_sigma_rad_s;                    ///< with this standard deviation,
  std::optional<Eigen::Vector3d> bias_rad_s;  ///< unless it is given.
  ThreeAxisFaults faults;
};

/// Attitude at separation that the launcher reports.
struct LauncherTelling {
  double sigma_rad;                        ///< Standard deviation about each axis.
  std::optional<Eigen::Vector3d> off_rad;  ///< Error of the report; drawn where empty.
};

struct SeparationScenario {
  ThreeAxisView view;
  SeparationTruth truth;
  double first_star_fix_s;  ///< T4: time of the first star fix.
  std::optional<LauncherTelling> launcher;
};

struct TumblingScenario {
  ThreeAxisView view;
  TumblingTruth truth;
};

struct OrientationScenario {
  ThreeAxisView view;
  OrientationTruth truth;
};

struct RescueScenario {
  ThreeAxisView view;
  RescueTruth truth;
};

struct FlownBody {
  BodyMotion motion;
  Eigen::Vector3d bias_rad_s;  ///< Bias of the gyro.
  ThreeAxisTelemetry telemetry;
};

struct FlownSeparation {
  FlownBody body;
  std::optional<Euler312> told;  ///< Report of the launcher: body in the orbit frame at T1.
};

struct FlownOrientation {
  FlownBody body;
  std::vector<ControlRecord> record;
  OrientationOutcome outcome;
};

struct FlownRescue {
  FlownBody body;
  RescueOutcome outcome;
};

/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for what
///         cannot be flown (see each motion); Unobservable for a launcher's report without an orbit
///         frame.
Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit);
Expected<FlownBody> flown(const TumblingScenario& scenario, const Orbit& orbit);
Expected<FlownOrientation> flown(const OrientationScenario& scenario, const Orbit& orbit);
Expected<FlownRescue> flown(const RescueScenario& scenario, const Orbit& orbit);

}  // namespace spindrift
