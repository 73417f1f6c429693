/// @file
/// What in an orbit file that was read a person should look at.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/ephemeris/oem.h"

namespace spindrift {

/// One sentence a doubt, none where there is no doubt: that it is the orbit of another spacecraft,
/// going by its OBJECT_NAME and OBJECT_ID, which may be no more than another name; that it jumps;
/// that its segments do not meet; that it has gaps.
/// @param file as the mission file names it.
std::vector<std::string> orbit_doubts(const OrbitEphemeris& ephemeris, std::string_view file,
                                      std::string_view spacecraft_id);

}  // namespace spindrift
