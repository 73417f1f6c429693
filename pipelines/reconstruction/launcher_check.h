/// @file
/// Compares the attitude at separation with the one that the launch vehicle reported.

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/launch_frame.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/attitude_difference.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/reconstruction/reconstruction.h"

namespace spindrift {

/// Holds the attitude of the spacecraft body in the orbit frame at T1.
struct InOrbitFrame {
  Euler312 angles;
};

/// Uses the chain body -> launch inertial -> north-east-down of the site -> Earth-fixed -> ICRF.
struct InLaunchFrame {
  Euler312 angles;
  Launch launch;
};

struct LauncherAttitude {
  std::variant<InOrbitFrame, InLaunchFrame> told;
  double sigma_rad;  ///< Standard deviation per body axis.
};

struct LauncherCheck {
  Eigen::Quaterniond q_icrf_body;  ///< Attitude reported by the launcher.
  AttitudeDifference difference;   ///< Turn from the launcher's attitude to the reconstructed.
  /// Probability of at least this difference by errors alone: chi-square, 3 degrees of freedom.
  double chance;
};

/// @param separation Attitude at T1.
/// @param orbit Needed for an attitude in the orbit frame only.
/// @return InvalidConfiguration if the sigma is not positive; NoCoverage or Unobservable without an
///         orbit frame at T1.
Expected<LauncherCheck> launcher_check(const LauncherAttitude& launcher,
                                       const ReconstructedAttitude& separation,
                                       const std::optional<Orbit>& orbit);

}  // namespace spindrift
