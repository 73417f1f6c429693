/// @file
/// What is known of every node of a chain, in time and memory that grow linearly with it: an
/// information filter with bias and misalignment beside each node, then a smoother.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/reconstruction/chain.h"

namespace spindrift {

/// Bias, and misalignment where it is estimated: three or six unknowns.
using Shared = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using PerShared = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6>;

struct ChainCovariance {
  Shared shared;
  std::vector<Eigen::Matrix3d> nodes_rad2;
  std::vector<PerShared> node_shared;  ///< Between each node and the shared unknowns.
};

/// Of a solution.
ChainCovariance covariance_of(const Chain& chain, const ChainState& state);

}  // namespace spindrift
