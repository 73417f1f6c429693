/// @file
/// A separation from the launcher as it is flown and seen from the ground.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"
#include "pipelines/ground_model/separation/separation_motion.h"

namespace spindrift {

/// What the launcher will tell of the attitude at separation.
struct LauncherTelling {
  double sigma_rad;                        ///< About each axis.
  std::optional<Eigen::Vector3d> off_rad;  ///< It is wrong by this; drawn where empty.
};

struct SeparationScenario {
  std::uint64_t seed;
  SeparationTruth truth;
  double first_star_fix_s;                    ///< T4
  ThreeAxisSensors sensors;                   ///< The bias of the gyro is drawn
  double bias_sigma_rad_s;                    ///< by this,
  std::optional<Eigen::Vector3d> bias_rad_s;  ///< unless it is given.
  ThreeAxisFaults faults;
  std::optional<LauncherTelling> launcher;
};

struct FlownSeparation {
  BodyMotion motion;
  Eigen::Vector3d bias_rad_s;  ///< Of the gyro.
  ThreeAxisTelemetry telemetry;
  std::optional<Euler312> told;  ///< By the launcher: body in the orbit frame at T1.
};

/// @return NoCoverage where the orbit, or the field for a magnetometer, ends before; Unobservable
///         where the launcher is to tell and there is no orbit frame at T1.
Expected<FlownSeparation> flown(const SeparationScenario& scenario, const Orbit& orbit);

}  // namespace spindrift
