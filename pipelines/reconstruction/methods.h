/// @file
/// The two ways from the star fixes back to T2. Both end with the same arc: from T2 back to T1 the
/// body turns without torques, by its inertia, or at a constant rate where that is unknown.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"

namespace spindrift {

/// The likeliest history from T2 on, of all samples at once, with the bias of the gyro.
/// @return Unobservable where no minimum is found.
Expected<Reconstruction> reconstruct_batch(const ReconstructionRequest& request,
                                           const Observations& all);

/// Step by step from the star fix at T4, each attitude corrected to the sun vector it has; the bias
/// of the gyro stays in it, and in its covariance.
/// @return Unobservable where a step is not solved.
Expected<Reconstruction> reconstruct_sequential(const ReconstructionRequest& request,
                                                const Observations& all);

}  // namespace spindrift
