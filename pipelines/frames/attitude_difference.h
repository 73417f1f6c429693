/// @file
/// How far two attitudes lie apart, and whether their errors explain it.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"

namespace spindrift {

/// The true one is q_ref_body * quaternion_by(error), the error small.
struct UncertainAttitude {
  Eigen::Quaterniond q_ref_body;    ///< Unit.
  Eigen::Matrix3d covariance_rad2;  ///< Of the error, body axes.
};

struct AttitudeDifference {
  double angle_rad;   ///< [0, pi]
  double chi_square;  ///< Of three degrees of freedom where errors alone keep the two apart.
};

/// @return InvalidInput where the covariances leave an axis without any error.
Expected<AttitudeDifference> attitude_difference(const UncertainAttitude& a,
                                                 const UncertainAttitude& b);

}  // namespace spindrift
