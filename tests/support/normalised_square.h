/// @file
/// An error in units of what a covariance promises.

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace spindrift::testing {

/// Squared, summed over the directions: its mean is their number.
template <int kDirections>
double normalised_square(const Eigen::Matrix<double, kDirections, 1>& error,
                         const Eigen::Matrix<double, kDirections, kDirections>& covariance) {
  return error.dot(covariance.inverse() * error);
}

}  // namespace spindrift::testing
