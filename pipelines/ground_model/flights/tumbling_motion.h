/// @file
/// A body that nobody controls: it turns as it was left, and as its surroundings make it.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/flights/body_flight.h"

namespace spindrift {

struct TumblingTruth {
  BodyTruth body;
  Eigen::Vector3d wheels_body_nms = Eigen::Vector3d::Zero();  ///< What they hold and keep.
};

/// In steps in which the body turns by a fiftieth of a radian, of a second at most.
/// @return NoCoverage where the orbit or the field ends before; InvalidConfiguration for a body
///         that cannot be, and one that comes to turn five times as fast.
Expected<BodyMotion> tumbling_motion(const TumblingTruth& truth, const Orbit& orbit);

}  // namespace spindrift
