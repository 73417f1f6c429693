/// @file
/// How far two attitudes lie apart, and whether their errors explain it.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/frames/uncertain_attitude.h"

namespace spindrift {

struct AttitudeDifference {
  double angle_rad;  ///< [0, pi]
  /// Chi-square with three degrees of freedom where errors alone separate them.
  double chi_square;
};

/// @return InvalidInput where the covariances leave an axis without any error.
Expected<AttitudeDifference> attitude_difference(const UncertainAttitude& a,
                                                 const UncertainAttitude& b);

}  // namespace spindrift
