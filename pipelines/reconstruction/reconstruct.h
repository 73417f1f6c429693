/// @file
/// Reconstructs the attitude at separation and its history, backwards from the first star fix.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// Solves a request; the result is bit-identical for identical requests.
/// @return InvalidConfiguration (sensors, inertia, sigmas), InvalidInput (times out of order or
///         outside the samples, non-finite values, quaternions and vectors not of unit length),
///         Unobservable (no gyro; no star fix as an anchor; no solution found). Messages name the
///         value and what is allowed.
Expected<Reconstruction> reconstruct(const ReconstructionRequest& request,
                                     ReconstructionMethod method);

}  // namespace spindrift
