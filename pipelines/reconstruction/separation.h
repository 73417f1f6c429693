/// @file
/// Reconstructs the attitude at separation and its history, backwards from the first star fix;
/// expresses it in the orbit frame and compares it with the one that the launch vehicle reported.

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

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

/// Compares the attitude at separation with the reported one.
/// @param separation Attitude at T1.
/// @param orbit Needed for an attitude in the orbit frame only.
/// @return InvalidConfiguration if the sigma is not positive; NoCoverage or Unobservable without an
///         orbit frame at T1.
Expected<LauncherCheck> launcher_check(const LauncherAttitude& launcher,
                                       const ReconstructedAttitude& separation,
                                       const std::optional<Orbit>& orbit);

struct ReconstructedSeparation {
  Reconstruction solution;
  /// Body attitude in the orbit frame at each event, or NoCoverage or Unobservable if that frame
  /// does not exist. Empty if no orbit is known.
  std::vector<Expected<Euler312Reading>> in_orbit_frame;
  std::optional<Expected<LauncherCheck>> launcher;  ///< Empty if the launcher reported nothing.
  std::int64_t samples = 0;  ///< Samples in the request; a later request of the pass has more.
};

ReconstructedSeparation separation_of(Reconstruction solution, const std::optional<Orbit>& orbit,
                                      const std::optional<LauncherAttitude>& launcher);

/// Solves a request; the result is bit-identical for identical requests.
/// @return InvalidConfiguration (sensors, inertia, sigmas), InvalidInput (times out of order or
///         outside the samples, non-finite values, quaternions and vectors not of unit length),
///         Unobservable (no gyro; no star fix as an anchor; no solution found). Messages name the
///         value and what is allowed.
Expected<Reconstruction> reconstruct(const ReconstructionRequest& request,
                                     ReconstructionMethod method);

/// Solves a request. @return Errors as listed at reconstruct().
Expected<ReconstructedSeparation> reconstruct_separation(
    const ReconstructionRequest& request, ReconstructionMethod method,
    const std::optional<LauncherAttitude>& launcher);

}  // namespace spindrift
