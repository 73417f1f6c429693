/// @file
/// What the Earth's motion does to the edges of a revolution. Fixes and residuals are of an Earth
/// at rest where the sightlines have it; each edge meets it where it has moved to: by 0.3 deg where
/// a slow body's beams cross it half a turn apart, by 0.07 deg between the two edges of a chord.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/config.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/sightlines.h"

namespace spindrift {

/// By how many of its standard deviations each edge is late because of it, by channel. What a
/// measurement shows of that is the scalar product with its `noise_rad`.
/// @param axis_icrf Unit. Chords that it does not explain are left as they are.
EdgeNoise late_by_earth_motion(const SpinConfig& config, const RevolutionMeasurements& measured,
                               const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf);

}  // namespace spindrift
