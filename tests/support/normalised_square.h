/// @file
/// The squared error of an estimate normalised by its covariance (NEES).

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace spindrift::testing {

/// Returns the NEES, whose expectation is the number of directions.
template <int kDirections>
double normalised_square(const Eigen::Matrix<double, kDirections, 1>& error,
                         const Eigen::Matrix<double, kDirections, kDirections>& covariance) {
  return error.dot(covariance.inverse() * error);
}

}  // namespace spindrift::testing
