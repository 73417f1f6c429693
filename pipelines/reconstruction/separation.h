/// @file
/// A reconstruction in the frames that people ask for, beside what the launcher told.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/reconstruction/launcher_check.h"
#include "pipelines/reconstruction/reconstruction.h"

namespace spindrift {

struct ReconstructedSeparation {
  Reconstruction solution;
  /// The body in the orbit frame at each event; NoCoverage or Unobservable where there is no such
  /// frame. Empty: no orbit is known.
  std::vector<Expected<Euler312Reading>> in_orbit_frame;
  std::optional<Expected<LauncherCheck>> launcher;  ///< Empty: the launcher told nothing.
};

ReconstructedSeparation separation_of(Reconstruction solution, const std::optional<Orbit>& orbit,
                                      const std::optional<LauncherAttitude>& launcher);

}  // namespace spindrift
