/// @file
/// Warnings about a doubtful orbit of a loaded mission.

#pragma once

#include <filesystem>

#include "services/mission/mission.h"

namespace spindrift {

/// Logs a warning for each doubt. @param file The mission file.
void warn_of_orbit(const std::filesystem::path& file, const Mission& mission);

}  // namespace spindrift
