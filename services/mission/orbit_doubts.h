/// @file
/// Checks an orbit file for things that a person should look at.

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
