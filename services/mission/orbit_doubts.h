/// @file
/// Checks an orbit file for things that a person should look at.
///
/// A doubt is no problem: the file is used, and every command that uses it warns. A jump turns the
/// nadir by its size over the distance, and the axis by that or several times that; no sigma
/// includes it.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// Returns one sentence per doubt: the OBJECT_NAME and OBJECT_ID may belong to another spacecraft
/// (or be another name of this one), the orbit jumps, segments do not meet, there are gaps.
/// @param file Path as the mission file names it.
std::vector<std::string> orbit_doubts(const OrbitEphemeris& ephemeris, std::string_view file,
                                      std::string_view spacecraft_id);

}  // namespace spindrift
