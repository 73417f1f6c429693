/// @file
/// Rates how far a reconstruction can be trusted, with reasons.

#pragma once

#include "pipelines/core/assessment.h"
#include "pipelines/reconstruction/chain_covariance.h"
#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/star_consensus.h"

namespace spindrift {

/// Assesses a reconstruction:
/// OK          nothing contradicts it
/// CONVERGING  nothing contradicts it, but it rests on one star fix and no sun vector checks it
/// DOUBTFUL    a sensor scatters beyond its noise or has many outliers; the first gyro sample
///             after T2 is an outlier; the gyro was saturated, frozen or silent for more than 10 s;
///             a third of the star fixes are gated or they contradict each other; the bias, or an
///             error of the mission file, is implausible; or the attitude at T1 has a sigma above
///             10 deg
/// @param result The complete reconstruction except its assessment.
/// @param file Errors of the mission file that explain the samples best.
Assessment assess(const ReconstructionRequest& request, const Observations& all,
                  const Reconstruction& result, const StarConsensus& stars, const FittedFile& file);

}  // namespace spindrift
