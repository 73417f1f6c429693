/// @file
/// Names what a pass says of the errors of the mission file of a three-axis spacecraft.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/observation/normal_equations.h"
#include "pipelines/three_axis/alignment.h"

namespace spindrift {

/// Returns normal equations in the units and with the names of [calibration]; their b0 is zero.
/// @param errors Which error each row is, an AttitudeAlignmentError.
/// @param information, score Of these errors, in the units of the pipeline.
NormalEquations named_equations(TaiTime t, std::span<const int> errors,
                                const Eigen::MatrixXd& information, const Eigen::VectorXd& score);

}  // namespace spindrift
