/// @file
/// Holes of an orbit ephemeris, between its segments or within one.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// Returns the ephemeris with its segments cut in two at every hole: a step of more than 1.5 times
/// the shortest of its segment, halfway through which the interpolation is more than 1 km from
/// where two-body motion and both its ends put it (`halfway_icrf_km`). So steps may change as long
/// as the interpolation bridges them, and uniformly sparse states are accepted. A part with fewer
/// points than its interpolation needs is left out.
/// @return InvalidConfiguration, with the line, where nothing is left.
Expected<OrbitEphemeris> cut_at_holes(const OrbitEphemeris& ephemeris);

/// A span that no segment covers, between two that do.
struct OrbitGap {
  TaiTime from;
  TaiTime to;
  int line;  ///< Line of the first state after the gap.
};

/// Returns the gaps in order of time.
std::vector<OrbitGap> orbit_gaps(const OrbitEphemeris& ephemeris);

}  // namespace spindrift
