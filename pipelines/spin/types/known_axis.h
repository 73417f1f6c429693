/// @file
/// An axis that is known beforehand, or from what the pass has shown so far.

#pragma once

#include <Eigen/Core>

namespace spindrift {

struct KnownAxis {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  double sigma_rad;
};

}  // namespace spindrift
