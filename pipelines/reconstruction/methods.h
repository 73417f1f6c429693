/// @file
/// The two reconstruction methods from the star fixes back to T2. Both continue to T1 by the same
/// arc: torque-free motion by the inertia, or a constant rate if the inertia is unknown.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// Estimates the maximum-likelihood history from T2 on from all samples, including the gyro bias.
/// @return Unobservable if the iteration does not converge.
Expected<Reconstruction> reconstruct_batch(const ReconstructionRequest& request,
                                           const Observations& all);

/// Steps back from the star fix at T4 and corrects each attitude to its sun vector. The gyro bias
/// is not estimated but is part of the covariance.
/// @return Unobservable if a step is not solved.
Expected<Reconstruction> reconstruct_sequential(const ReconstructionRequest& request,
                                                const Observations& all);

}  // namespace spindrift
