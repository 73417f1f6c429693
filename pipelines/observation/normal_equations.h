/// @file
/// What one pass says of the parameters b of the mission file: the ground of a calibration over
/// many passes, which solves (B^-1 + sum N) db = sum [g + N (b0 - mean)] with the prior B.

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the whitened normal equations with the unknowns of the pass eliminated, at the pass's
/// solution:
///
///     N = J_b'WJ_b - J_b'WJ_x (J_x'WJ_x)^+ J_x'WJ_b,   g likewise from J_b'Wr.
struct NormalEquations {
  TaiTime t;                       ///< Time of the solution that they belong to.
  std::vector<std::string> names;  ///< Keys as in [calibration] of the mission file.
  Eigen::VectorXd b0;              ///< Values of the mission file, in the units of the names.
  Eigen::MatrixXd n;               ///< Information on b, in the inverse squared units.
  Eigen::VectorXd g;               ///< Score of b at b0, in the inverse units.
};

}  // namespace spindrift
