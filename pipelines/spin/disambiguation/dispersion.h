/// @file
/// Dispersion test: finds which of several continuous branches of candidate axes is constant, since
/// Sun and Earth move and the true axis does not.
///
/// The likelihood ratio is used for mirror images only. Using it for all candidates was rejected:
/// it chose a false one in one of 200 passes with near-tangent candidates.

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/fix/axis_candidates.h"

namespace spindrift {

/// Motion of an axis per constant error, each of unit variance: the allowed model errors, and those
/// that the mission file states.
inline constexpr int kAllowedErrors = kModelErrors + kSpinAlignmentErrors;
using AllowedShift = Eigen::Matrix<double, 3, kAllowedErrors>;

/// Squared distance between an axis and a candidate, in standard deviations of the candidate.
/// @param mean_of How many such candidates `axis_icrf` is the mean of.
double squared_distance(const Eigen::Vector3d& axis_icrf, const AxisCandidate& candidate,
                        double mean_of);

/// An axis that stays where it is, the mean of `count` candidates.
struct StationaryAxis {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double count;
};

/// A branch that stays in place, and the evidence for that.
struct StationaryBranch {
  StationaryAxis axis;
  /// Least ratio of the variance of another branch to that of this one, each in units of its noise;
  /// that of this branch counts at least as its noise.
  double scatter_ratio;
  /// Natural logarithm of the least likelihood ratio. Empty: the F-test of the scatters was enough.
  std::optional<double> log_likelihood_ratio;
};

/// Follows the candidates of successive revolutions in branches, and sums each branch up in blocks.
/// Blocks grow so that their number stays below the window, and a slow turn of the geometry shows
/// too.
///
/// The scatter of a branch's blocks is taken about the best constant axis with constant errors of
/// the model, normalised by the candidates' own covariances, so that branches of unequal noise
/// compare. A branch is steady when its scatter is that of noise, and less than that of every other
/// branch at a level of 1e-8: with some hundred tests in a pass, a false choice is one in a
/// million. Where the candidates mirror each other and are known well, it is also steady when its
/// sum of squares is so much less that it is e^30 times likelier to be constant.
class Dispersion {
 public:
  /// @param window Most blocks that a branch keeps.
  explicit Dispersion(std::size_t window);

  /// Adds one revolution's candidates. They are left out where it is unclear which belongs to which
  /// branch, or where they lie off the branches; after five such revolutions in a row the branches
  /// have crossed, or moved, and are given up.
  /// @return The steady branch, when there is one.
  std::optional<StationaryBranch> add(std::span<const AxisCandidate> candidates);

  /// Notes that the candidates are no mirror images, or some are near-tangent and the rest a
  /// selection: their noise differs, and only the F-test decides from here on.
  void note_unlike() { unlike_ = true; }

 private:
  struct Block {
    int count = 0;
    Eigen::Vector3d axis_sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_sum_rad2 = Eigen::Matrix3d::Zero();
    AllowedShift shift_sum = AllowedShift::Zero();

    void add(const AxisCandidate& candidate);
    void add(const Block& later);
  };
  struct Branch {
    StationaryAxis recent;
    std::vector<Block> blocks;
    long last_seen;
  };
  /// Branch of each candidate; empty for one that continues none.
  using Links = std::vector<std::optional<std::size_t>>;
  struct Matching {
    Links links;
    double cost;    ///< Sum of squared distances.
    double margin;  ///< Extra cost of the next best links.
  };
  struct Scatter {
    double squares;
    int half_freedom;
  };

  Matching match(std::span<const AxisCandidate> candidates) const;
  bool skips(std::span<const AxisCandidate> candidates, const Matching& matching);
  void extend(std::span<const AxisCandidate> candidates, const Links& links);
  void start(const AxisCandidate& candidate);
  void merge_blocks();
  static Scatter scatter_of(std::span<const Block> blocks);
  std::span<const Block> closed_blocks(const Branch& branch) const;
  bool nearly_linear() const;
  std::optional<StationaryBranch> steady() const;

  std::size_t window_;
  std::vector<Branch> branches_;
  int block_length_ = 1;
  long revolutions_ = 0;
  int skipped_ = 0;
  bool unlike_ = false;
};

}  // namespace spindrift
