/// @file
/// Whether to act on a reconstruction, and why.

#pragma once

#include "pipelines/core/assessment.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/star_consensus.h"

namespace spindrift {

/// OK          all is well
/// CONVERGING  likewise, but of one star fix and no sun vector: nothing checks it
/// DOUBTFUL    a sensor scatters by more than its noise or has many outliers, the gyro its
///             first sample behind T2; it was saturated, frozen or silent for more than 10 s; a
///             third of the star fixes are gated, or they contradict each other; the bias is not to
///             be believed, or the attitude at T1 is open by more than 10 deg
/// @param result All but its assessment.
Assessment assess(const ReconstructionRequest& request, const Observations& all,
                  const Reconstruction& result, const StarConsensus& stars);

}  // namespace spindrift
