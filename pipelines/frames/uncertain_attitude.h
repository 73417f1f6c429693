/// @file
/// An attitude with its error.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/angle.h"

namespace spindrift {

/// The true one is q_ref_body * quaternion_by(error), the error small.
struct UncertainAttitude {
  Eigen::Quaterniond q_ref_body;    ///< Unit.
  Eigen::Matrix3d covariance_rad2;  ///< Of the error, body axes.
};

/// Beyond it, one standard deviation of all axes together, an error is not small, and its
/// covariance has no meaning.
inline constexpr double kLargestSigma_rad = 1.0;

/// With a larger sigma an attitude, or the axis of a spin, is open: it is on a cone about the Sun,
/// the Earth or the field, more or less.
inline constexpr double kOpen_rad = 10.0 * kRadPerDeg;

}  // namespace spindrift
