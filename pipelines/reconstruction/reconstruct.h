/// @file
/// The attitude at separation and everything between, backwards from the first star fix.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// The same request gives the same result, bit for bit.
/// @return InvalidConfiguration (sensors, inertia, sigmas), InvalidInput (times out of order or
///         outside the samples, values that are not finite, quaternions and vectors not of unit
///         length), Unobservable (no gyro; no star fix: nothing can be anchored; no solution
///         found), naming the value and what is allowed.
Expected<Reconstruction> reconstruct(const ReconstructionRequest& request,
                                     ReconstructionMethod method);

}  // namespace spindrift
