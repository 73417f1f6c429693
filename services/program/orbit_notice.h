/// @file
/// When a mission has been loaded, says what is doubtful about its orbit.

#pragma once

#include <filesystem>

#include "services/mission/mission.h"

namespace spindrift {

/// A warning for each doubt. `file` is the mission file.
void warn_of_orbit(const std::filesystem::path& file, const Mission& mission);

}  // namespace spindrift
