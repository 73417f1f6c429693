/// @file
/// The current time. Only provenance and health depend on it, no computed result.

#pragma once

#include <string>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns ISO 8601 to the millisecond, ending in Z.
std::string utc_now();

TaiTime tai_now();

}  // namespace spindrift
