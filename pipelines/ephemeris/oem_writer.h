/// @file
/// An orbit as the text of a CCSDS Orbit Ephemeris Message (502.0-B, KVN).

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

/// States at even steps from `from` to `to`, which is later; each at most `step`.
/// @return NoCoverage where the orbit ends before.
Expected<std::vector<EphemerisPoint>> sampled_orbit(const Orbit& orbit, TaiTime from, TaiTime to,
                                                    std::chrono::seconds step);

/// One segment, EME2000, UTC, Hermite of degree 7; micrometres and nanoseconds are kept. Every
/// minute a point is enough for any orbit of the Earth: `parse_oem` gives it back within a
/// millimetre.
///
/// @param object Name of the spacecraft, also taken for its number. @param created Of the file.
/// @param points At least two, in order of time.
std::string oem_text(std::string_view object, TaiTime created,
                     const std::vector<EphemerisPoint>& points);

}  // namespace spindrift
