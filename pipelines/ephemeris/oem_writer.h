/// @file
/// Writes an orbit as a CCSDS Orbit Ephemeris Message (502.0-B, KVN).

#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns states at equal steps of at most `step` from `from` to `to`, which is later.
/// @return NoCoverage where the orbit ends earlier.
Expected<std::vector<EphemerisPoint>> sampled_orbit(const Orbit& orbit, TaiTime from, TaiTime to,
                                                    std::chrono::seconds step);

/// Returns a message of one segment, EME2000, UTC, Hermite of degree 7; micrometres and nanoseconds
/// are kept. With a point every minute `parse_oem` gives any orbit of the Earth back within a
/// millimetre.
///
/// @param object Name of the spacecraft, also used as its number. @param created Creation date.
/// @param points At least two, in order of time.
std::string oem_text(std::string_view object, TaiTime created,
                     const std::vector<EphemerisPoint>& points);

}  // namespace spindrift
