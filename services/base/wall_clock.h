/// @file
/// What time it is now. Nothing that is computed depends on it: only provenance and health do.

#pragma once

#include <string>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// ISO 8601 to the millisecond, ending in Z.
std::string utc_now();

TaiTime tai_now();

}  // namespace spindrift
