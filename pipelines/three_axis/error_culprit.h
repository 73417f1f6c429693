/// @file
/// This file says which sensor is wrong where the innovations of a filter contradict what the
/// mission file states (alignment_evidence.h): the one whose errors, if nothing were stated of
/// them, would leave those of all others as stated.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/three_axis/alignment_evidence.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the contradiction, with the culprit if one sensor alone explains it, and with both if
/// each of two does; empty if none or more do.
/// @param rate_body_rad_s Rate at which the errors are told as an angle.
/// @param since Time since when they contradict each other.
std::optional<SensorContradiction> contradiction_by_errors(const AlignmentEvidence& evidence,
                                                           const Eigen::Vector3d& rate_body_rad_s,
                                                           TaiTime since);

}  // namespace spindrift
