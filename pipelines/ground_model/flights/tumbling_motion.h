/// @file
/// Motion of an uncontrolled body: free rotation under disturbance torques.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/flights/body_flight.h"

namespace spindrift {

struct TumblingTruth {
  BodyTruth body;
  Eigen::Vector3d wheels_body_nms = Eigen::Vector3d::Zero();  ///< Constant momentum of the wheels.
};

/// Simulates in steps of at most 1 s, and of at most 0.01 rad at the rate of the start.
/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia, and for a body that comes to turn too fast for the step.
Expected<BodyMotion> tumbling_motion(const TumblingTruth& truth, const Orbit& orbit);

}  // namespace spindrift
