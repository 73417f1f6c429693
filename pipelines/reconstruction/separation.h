/// @file
/// Expresses a reconstruction in the orbit frame and compares it with the launcher's report.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/reconstruction/launcher_check.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

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

/// Solves a request. @return Errors as listed at reconstruct().
Expected<ReconstructedSeparation> reconstruct_separation(
    const ReconstructionRequest& request, ReconstructionMethod method,
    const std::optional<LauncherAttitude>& launcher);

}  // namespace spindrift
