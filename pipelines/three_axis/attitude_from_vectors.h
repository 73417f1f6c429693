/// @file
/// Attitude from directions that are known in the body and in a reference frame.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/frames/uncertain_attitude.h"

namespace spindrift {

/// Directions need no unit length.
struct ObservedDirection {
  Eigen::Vector3d body;  ///< As measured.
  Eigen::Vector3d ref;   ///< As known: ICRF, or another frame.
  double sigma_rad;      ///< One standard deviation of `body` along each of two axes across it.
};

/// What a direction says of the attitude, 1/rad^2, body axes: nothing about itself.
Eigen::Matrix3d information_of(const ObservedDirection& direction);

/// TRIAD (Liu 2019, eq. 10 to 12): `first` exactly, `second` as near as that leaves it; covariance
/// by Shuster and Oh 1981.
/// @return Unobservable where the two are so nearly in line that the turn about it is known to no
///         better than 1 rad.
Expected<UncertainAttitude> triad(const ObservedDirection& first, const ObservedDirection& second);

/// The attitude of the least sum of squares (body - A ref)^2 / sigma^2 (Wahba's problem), by
/// Davenport's q-method: the eigenvector of a 4 x 4 matrix, singular nowhere.
/// @return Unobservable as `triad`; likewise for fewer than two directions.
Expected<UncertainAttitude> q_method(std::span<const ObservedDirection> directions);

}  // namespace spindrift
