/// @file
/// The Cramer-Rao bound: the lowest covariance of the axis that any estimator can reach.

#pragma once

#include <Eigen/Core>

#include "tests/support/spinning_body.h"

namespace spindrift::testing {

/// Returns the Cramer-Rao bound of the axis in its tangent plane, rad^2, with phase and rate
/// unknown. The Fisher information comes from central differences of the oracle's edges.
Eigen::Matrix2d cramer_rao_rad2(const SpinningBody& body, const SunEarthEphemeris& around,
                                double duration_s);

}  // namespace spindrift::testing
