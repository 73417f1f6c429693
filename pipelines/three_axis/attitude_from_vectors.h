/// @file
/// Estimates attitude from directions known both in the body and in a reference frame.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/frames/uncertain_attitude.h"

namespace spindrift {

/// Holds one direction in both frames; the vectors need not have unit length.
struct ObservedDirection {
  Eigen::Vector3d body;  ///< Measured direction, body axes.
  Eigen::Vector3d ref;   ///< Reference direction, ICRF or another frame.
  double sigma_rad;      ///< Standard deviation of `body` along each of two axes across it.
};

/// Returns the attitude information of one direction, 1/rad^2, body axes; zero along itself.
Eigen::Matrix3d information_of(const ObservedDirection& direction);

/// Computes the attitude by TRIAD (Liu 2019, eq. 10 to 12): it fits `first` exactly and `second` as
/// closely as that permits. The covariance follows Shuster and Oh 1981.
/// @return Unobservable if they are so nearly collinear that the turn about them is open by 1 rad.
Expected<UncertainAttitude> triad(const ObservedDirection& first, const ObservedDirection& second);

/// Solves Wahba's problem: minimises the sum of (body - A ref)^2 / sigma^2 by Davenport's q-method.
/// The solution is an eigenvector of a 4 x 4 matrix and has no singular attitude.
/// @return Unobservable for fewer than two directions, or if they are collinear as in `triad`.
Expected<UncertainAttitude> q_method(std::span<const ObservedDirection> directions);

}  // namespace spindrift
