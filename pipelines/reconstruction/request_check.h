/// @file
/// Validates the values of a reconstruction request.

#pragma once

#include <optional>

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// Checks sensors, inertia, sigmas and every single sample, but not the event times.
std::optional<Error> refusal_of(const ReconstructionRequest& request);

}  // namespace spindrift
