/// @file
/// Computes the covariance of every node of a chain in linear time and memory, by an information
/// filter augmented with bias and misalignment, followed by a smoother.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/reconstruction/chain.h"

namespace spindrift {

/// Matrix over the shared unknowns: the bias, and the misalignment if it is estimated (3 or 6).
using Shared = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using PerShared = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6>;

struct ChainCovariance {
  Shared shared;
  std::vector<Eigen::Matrix3d> nodes_rad2;
  std::vector<PerShared> node_shared;  ///< Covariance of each node with the shared unknowns.
};

/// Returns the covariance at a solution.
ChainCovariance covariance_of(const Chain& chain, const ChainState& state);

}  // namespace spindrift
