/// @file
/// A reconstruction in the frames that people ask for, beside what the launcher told.

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
  /// The body in the orbit frame at each event; NoCoverage or Unobservable where there is no such
  /// frame. Empty: no orbit is known.
  std::vector<Expected<Euler312Reading>> in_orbit_frame;
  std::optional<Expected<LauncherCheck>> launcher;  ///< Empty: the launcher told nothing.
  std::int64_t samples = 0;  ///< That the request had: of two of one pass the later has more.
};

ReconstructedSeparation separation_of(Reconstruction solution, const std::optional<Orbit>& orbit,
                                      const std::optional<LauncherAttitude>& launcher);

/// Of a request by itself. @return As reconstruct().
Expected<ReconstructedSeparation> reconstruct_separation(
    const ReconstructionRequest& request, ReconstructionMethod method,
    const std::optional<LauncherAttitude>& launcher);

}  // namespace spindrift
