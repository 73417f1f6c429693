/// @file
/// Forward selection of biases: significant ones are estimated, one after the other.

#pragma once

#include <Eigen/Core>
#include <span>

#include "pipelines/spin/batch/explained.h"

namespace spindrift {

struct AddedBiases {
  Explained best;             ///< With all that are wanted.
  Eigen::Matrix2d open_rad2;  ///< What the choice among them leaves open of the axis, tilts.
};

/// @return As fit().
Expected<AddedBiases> add_wanted_biases(const PassModel& model, std::span<const PassEdge> edges,
                                        Explained without);

}  // namespace spindrift
