/// @file
/// Flights of a three-axis spacecraft as they are flown, and seen from the ground.

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

/// How the ground sees a body.
struct ThreeAxisView {
  std::uint64_t seed;
  ThreeAxisSensors sensors;                   ///< The bias of the gyro is drawn
  double bias_sigma_rad_s;                    ///< by this,
  std::optional<Eigen::Vector3d> bias_rad_s;  ///< unless it is given.
  ThreeAxisFaults faults;
};

/// What the launcher will tell of the attitude at separation.
struct LauncherTelling {
  double sigma_rad;                        ///< About each axis.
  std::optional<Eigen::Vector3d> off_rad;  ///< It is wrong by this; drawn where empty.
};

struct SeparationScenario {
  ThreeAxisView view;
  SeparationTruth truth;
  double first_star_fix_s;  ///< T4
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
  Eigen::Vector3d bias_rad_s;  ///< Of the gyro.
  ThreeAxisTelemetry telemetry;
};

struct FlownSeparation {
  FlownBody body;
  std::optional<Euler312> told;  ///< By the launcher: body in the orbit frame at T1.
};

struct FlownOrientation {
  FlownBody body;
  std::vector<ControlRecord> record;
  OrientationOutcome outcome;
};

/// @return NoCoverage where the orbit or the field ends before; InvalidConfiguration for what
/// cannot
///         be flown (see each motion); Unobservable where a launcher is to tell and there is no
///         orbit frame at T1.
Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit);
Expected<FlownBody> flown(const TumblingScenario& scenario, const Orbit& orbit);
Expected<FlownOrientation> flown(const OrientationScenario& scenario, const Orbit& orbit);

}  // namespace spindrift
