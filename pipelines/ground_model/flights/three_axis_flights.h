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
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "pipelines/ground_model/flights/separation_motion.h"
#include "pipelines/ground_model/flights/tumbling_motion.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"

namespace spindrift {

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

/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for what
///         cannot be flown (see each motion); Unobservable for a launcher's report without an orbit
///         frame.
Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit);
Expected<FlownBody> flown(const TumblingScenario& scenario, const Orbit& orbit);
Expected<FlownOrientation> flown(const OrientationScenario& scenario, const Orbit& orbit);

}  // namespace spindrift
