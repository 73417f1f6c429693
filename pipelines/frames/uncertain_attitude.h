/// @file
/// An attitude with its error, and how far two of them lie apart.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"
#include "pipelines/frames/angle.h"

namespace spindrift {

/// Attitude whose true value is q_ref_body * quaternion_by(error), with a small error.
struct UncertainAttitude {
  Eigen::Quaterniond q_ref_body;    ///< Unit quaternion.
  Eigen::Matrix3d covariance_rad2;  ///< Covariance of the error, body axes.
};

/// Largest sigma of all axes together: beyond it errors are not small and covariances meaningless.
inline constexpr double kLargestSigma_rad = 1.0;

/// With a larger sigma an attitude, or the axis of a spin, is open: all that is known is a cone
/// about the Sun, the Earth or the field.
inline constexpr double kOpen_rad = 10.0 * kRadPerDeg;

/// How far two attitudes lie apart, and whether their errors explain it.
struct AttitudeDifference {
  double angle_rad;  ///< [0, pi]
  /// Chi-square with three degrees of freedom where errors alone separate them.
  double chi_square;
};

/// @return InvalidInput where the covariances leave an axis without any error.
Expected<AttitudeDifference> attitude_difference(const UncertainAttitude& a,
                                                 const UncertainAttitude& b);

}  // namespace spindrift
