/// @file
/// The attitude at separation beside the launch vehicle's own figure of it.

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

/// Of the spacecraft's body at T1.
struct InOrbitFrame {
  Euler312 angles;
};

/// The chain: body -> launch inertial -> north-east-down of the site -> Earth's axes -> ICRF.
struct InLaunchFrame {
  Euler312 angles;
  Launch launch;
};

struct LauncherAttitude {
  std::variant<InOrbitFrame, InLaunchFrame> told;
  double sigma_rad;  ///< Per body axis.
};

struct LauncherCheck {
  Eigen::Quaterniond q_icrf_body;  ///< The launcher's.
  AttitudeDifference difference;   ///< From the launcher's to the reconstructed one.
  /// That errors alone keep the two as far apart or farther: chi-square, 3 degrees of freedom.
  double chance;
};

/// @param separation Of T1.
/// @param orbit Not needed by the chain.
/// @return InvalidConfiguration where the sigma is not above 0; NoCoverage or Unobservable where
///         there is no orbit frame at T1.
Expected<LauncherCheck> launcher_check(const LauncherAttitude& launcher,
                                       const ReconstructedAttitude& separation,
                                       const std::optional<Orbit>& orbit);

}  // namespace spindrift
