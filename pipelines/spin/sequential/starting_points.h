/// @file
/// Where filters may begin: the candidates of fixes, averaged branch by branch until each is known
/// well enough. One fix is enough where edges are precise; with a fast body or noisy edges it takes
/// several.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

struct StartingPoint {
  Eigen::Vector3d axis_icrf;        ///< Unit.
  Eigen::Matrix2d covariance_rad2;  ///< Tangent plane at the axis: east, north.
};

/// It names a candidate, or none, and has not ruled out the others.
bool leaves_open(const SpinFix& fix);

/// The axis of the fix, and what it leaves open beside it.
std::vector<StartingPoint> candidates_of(const SpinFix& fix);

/// Near enough for edges to be linear about it.
bool well_known(const Eigen::Matrix2d& covariance_rad2);

/// Beyond the noise of both, and beyond what may be wrong with the model.
bool contradict(const StartingPoint& one, const StartingPoint& other);

class StartingPoints {
 public:
  /// What so many fixes say together: each point well known, the axis of the last fix first.
  struct Known {
    std::vector<StartingPoint> points;
    int fixes = 0;
  };

  /// @param fewest Fixes that speak together, however well they are known.
  explicit StartingPoints(int fewest = 1) : fewest_{fewest} {}

  /// @param candidates Of one fix.
  /// @return What is known of the branches that they belong to; empty until each of them is well
  ///         known.
  std::optional<Known> add(std::span<const StartingPoint> candidates);

  void forget();

 private:
  std::size_t branch_of(const StartingPoint& candidate,
                        const std::vector<std::size_t>& taken) const;

  int fewest_;
  int fixes_ = 0;
  std::vector<MeanAxis> branches_;
};

}  // namespace spindrift
