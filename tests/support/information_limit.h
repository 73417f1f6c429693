/// @file
/// How well any estimator can know the axis: the Cramer-Rao bound.

#pragma once

#include <Eigen/Core>

#include "tests/support/spinning_body.h"

namespace spindrift::testing {

/// The inverse of Fisher's information on the axis (its tangent plane), with phase and rate unknown
/// besides: how the edges of the oracle move when its body is changed a little, each way.
Eigen::Matrix2d cramer_rao_rad2(const SpinningBody& body, const SunEarthEphemeris& around,
                                double duration_s);

}  // namespace spindrift::testing
