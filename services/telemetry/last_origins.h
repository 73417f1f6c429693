/// @file
/// How far the sessions of sources had come before a restart.

#pragma once

#include <array>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/telemetry_sample.h"

namespace spindrift {

/// The highest seq that the archive holds of each session, by topic: in the order of the list of
/// kinds.
using LastOrigins = std::array<std::vector<Origin>, kTelemetryKindCount>;

}  // namespace spindrift
