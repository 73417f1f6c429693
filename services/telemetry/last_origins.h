/// @file
/// How far each session of a source had come before a restart.

#pragma once

#include <array>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

/// The highest seq of each session in the archive, for each kind in the order of the list.
using LastOrigins = std::array<std::vector<Origin>, kTelemetryKindCount>;

}  // namespace spindrift
