/// @file
/// Collects starting axes of filters: candidates of fixes, averaged branch by branch until each is
/// known well enough. One fix is enough where edges are precise; with a fast body or noisy edges it
/// takes several.

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
  Eigen::Vector3d axis_icrf;        ///< Unit vector.
  Eigen::Matrix2d covariance_rad2;  ///< Total, in the tangent plane at the axis: east, north.
  /// Part of the covariance that errors of the mission file make.
  Eigen::Matrix2d alignment_rad2 = Eigen::Matrix2d::Zero();
};

/// Returns whether the fix has not ruled out its other candidates.
bool leaves_open(const SpinFix& fix);

/// Returns the axis of the fix and the alternates that it leaves open.
std::vector<StartingPoint> candidates_of(const SpinFix& fix);

/// Returns whether the axis is known well enough to linearise edges about it.
bool well_known(const Eigen::Matrix2d& covariance_rad2);

/// Returns whether the points differ by more than their noise and the allowed model error.
bool contradict(const StartingPoint& one, const StartingPoint& other);

class StartingPoints {
 public:
  /// Holds the points from `fixes` fixes, each well known, with the axis of the last fix first.
  struct Known {
    std::vector<StartingPoint> points;
    int fixes = 0;
  };

  /// @param fewest Minimum number of fixes before points are known.
  explicit StartingPoints(int fewest = 1) : fewest_{fewest} {}

  /// @param candidates Candidates of one fix.
  /// @return The branches of these candidates; empty until each of them is well known.
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
