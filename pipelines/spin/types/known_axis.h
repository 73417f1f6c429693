/// @file
/// An axis that is known beforehand, or from what the pass has shown so far.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/products.h"

namespace spindrift {

struct KnownAxis {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  double sigma_rad;
  /// What told the axis from others; fixes chosen by the axis inherit it. Edges count as the
  /// dispersion does: over many turns one axis goes on fitting them.
  Resolution settled_by = Resolution::Dispersion;
};

}  // namespace spindrift
