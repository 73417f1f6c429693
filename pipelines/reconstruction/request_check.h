/// @file
/// What of a request cannot be true.

#pragma once

#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// Sensors, inertia, sigmas and every sample by itself; not the times.
std::optional<Error> refusal_of(const ReconstructionRequest& request);

}  // namespace spindrift
