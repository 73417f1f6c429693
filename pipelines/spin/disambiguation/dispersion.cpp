#include "pipelines/spin/disambiguation/dispersion.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/distributions.h"

namespace spindrift {
namespace {

constexpr double kLevel = 1e-8;
// Difference of squares for e^30 to one in the likelihood ratio, which sees a slow drift that the
// F-test spreads over all blocks: the branches come from the same measurements, so their noise is
// in both squares and the difference is what the other has drifted. But where candidates are known
// worse than kNearlyLinear_rad, or near-tangent, their curvature would be taken for a drift.
constexpr double kDecisive = 60.0;
constexpr double kNearlyLinear_rad = 1.2 * kRadPerDeg;
// A branch with more variance than this, in units of its noise, does not stay in place.
constexpr double kSteadyVariance = 2.5;
constexpr std::size_t kFewestBlocks = 3;
constexpr std::size_t kMostBranches = 4;
// Most candidates in the mean that a branch's next candidate is compared with.
constexpr double kRecent = 8.0;
// A candidate farther from its branch than this, in squared sigmas, does not continue it.
constexpr double kGate = 36.0;
// Ways to link candidates and branches whose costs differ by less cannot be told apart.
constexpr double kClear = 25.0;
constexpr int kSkippedInARow = 5;
// Share of the model errors that changes as the geometry turns: the oblate Earth's limb.
constexpr double kModelChange = 0.2;
// Floor of the sigma of a candidate, for rounding and errors that no model has.
constexpr double kFloor_rad = 0.02 * kRadPerDeg;

/// Returns the great-circle offset from `from` to `to`, in the tangent plane at `from`.
Eigen::Vector2d offset_rad(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           const Eigen::Matrix<double, 3, 2>& basis) {
  const Eigen::Vector2d along = basis.transpose() * to;
  const double sine = along.norm();
  return sine > 0.0 ? Eigen::Vector2d{along * (angle_between_rad(from, to) / sine)} : along;
}

AllowedShift allowed_shift_icrf(const AxisCandidate& candidate) {
  AllowedShift shift;
  shift << candidate.model_shift_icrf * kModelError_rad, candidate.alignment_shift_icrf;
  return shift;
}

}  // namespace

double squared_distance(const Eigen::Vector3d& axis_icrf, const AxisCandidate& candidate,
                        double mean_of) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(candidate.axis_icrf);
  const Eigen::Matrix<double, 2, kAllowedErrors> shift =
      basis.transpose() * allowed_shift_icrf(candidate);
  const Eigen::Matrix2d covariance_rad2 = candidate.covariance_rad2 * (1.0 + 1.0 / mean_of) +
                                          shift * shift.transpose() +
                                          kFloor_rad * kFloor_rad * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d off_rad = offset_rad(candidate.axis_icrf, axis_icrf, basis);
  return off_rad.dot(covariance_rad2.ldlt().solve(off_rad));
}

void Dispersion::Block::add(const AxisCandidate& candidate) {
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(candidate.axis_icrf);
  ++count;
  axis_sum += candidate.axis_icrf;
  covariance_sum_rad2 += basis * candidate.covariance_rad2 * basis.transpose();
  shift_sum += allowed_shift_icrf(candidate);
}

void Dispersion::Block::add(const Block& later) {
  count += later.count;
  axis_sum += later.axis_sum;
  covariance_sum_rad2 += later.covariance_sum_rad2;
  shift_sum += later.shift_sum;
}

Dispersion::Dispersion(std::size_t window) : window_{std::max(window, 2 * kFewestBlocks)} {}

std::optional<StationaryBranch> Dispersion::add(std::span<const AxisCandidate> candidates) {
  ++revolutions_;
  const Matching matching = match(candidates);
  if (!branches_.empty() && skips(candidates, matching)) {
    return std::nullopt;
  }
  extend(candidates, matching.links);
  std::erase_if(branches_, [&](const Branch& branch) {
    return revolutions_ - branch.last_seen > static_cast<long>(window_);
  });
  const bool block_closed =
      std::any_of(branches_.begin(), branches_.end(), [&](const auto& branch) {
        return branch.last_seen == revolutions_ && branch.blocks.back().count == block_length_;
      });
  auto found = block_closed ? steady() : std::nullopt;
  merge_blocks();
  return found;
}

/// Tries every way to link candidates and branches: there are at most four of either. The true axis
/// stays in place, so how far another has gone says nothing: all links beyond the gate cost the
/// same.
Dispersion::Matching Dispersion::match(std::span<const AxisCandidate> candidates) const {
  const std::size_t size = std::max(candidates.size(), branches_.size());
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), 0);
  Matching best{.links = Links(candidates.size()),
                .cost = std::numeric_limits<double>::infinity(),
                .margin = std::numeric_limits<double>::infinity()};
  std::array<std::array<double, kMostBranches>, kMostBranches> distances{};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t j = 0; j < branches_.size(); ++j) {
      const StationaryAxis& recent = branches_[j].recent;
      distances.at(i).at(j) = squared_distance(recent.axis_icrf, candidates[i], recent.count);
    }
  }
  do {
    Links links(candidates.size());
    double cost = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (order[i] < branches_.size()) {
        links[i] = order[i];
        cost += std::min(distances.at(i).at(order[i]), kGate);
      } else {
        cost += kGate;
      }
    }
    if (cost < best.cost) {
      best = {.links = links,
              .cost = cost,
              .margin = links == best.links ? best.margin : best.cost - cost};
    } else if (links != best.links) {
      best.margin = std::min(best.margin, cost - best.cost);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

bool Dispersion::skips(std::span<const AxisCandidate> candidates, const Matching& matching) {
  const bool unclear = matching.margin < kClear;
  std::size_t continued = 0;
  std::size_t linked = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (const auto& link = matching.links[i]) {
      const StationaryAxis& recent = branches_[*link].recent;
      ++linked;
      continued += squared_distance(recent.axis_icrf, candidates[i], recent.count) < kGate ? 1 : 0;
    }
  }
  if (!unclear && continued == linked) {
    skipped_ = 0;
    return false;
  }
  if (++skipped_ < kSkippedInARow) {
    return true;
  }
  skipped_ = 0;
  if (unclear || continued == 0) {  // The branches crossed, or all moved.
    branches_.clear();
    block_length_ = 1;
    return true;
  }
  // After a silence a false branch is elsewhere, while the true one has stayed.
  for (const auto& link : matching.links) {
    if (link) {
      branches_[*link].recent.count = 0.0;
    }
  }
  return false;
}

void Dispersion::extend(std::span<const AxisCandidate> candidates, const Links& links) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!links[i]) {
      start(candidates[i]);
      continue;
    }
    Branch& branch = branches_[*links[i]];
    branch.last_seen = revolutions_;
    branch.recent.count = std::min(branch.recent.count + 1.0, kRecent);
    branch.recent.axis_icrf +=
        (candidates[i].axis_icrf - branch.recent.axis_icrf) / branch.recent.count;
    branch.recent.axis_icrf.normalize();
    if (branch.blocks.back().count >= block_length_) {
      branch.blocks.emplace_back();
    }
    branch.blocks.back().add(candidates[i]);
  }
}

void Dispersion::start(const AxisCandidate& candidate) {
  if (branches_.size() == kMostBranches) {
    return;
  }
  branches_.push_back({.recent = {.axis_icrf = candidate.axis_icrf, .count = 1.0},
                       .blocks = {Block{}},
                       .last_seen = revolutions_});
  branches_.back().blocks.back().add(candidate);
}

void Dispersion::merge_blocks() {
  const bool full = std::any_of(branches_.begin(), branches_.end(), [&](const Branch& branch) {
    return branch.blocks.size() >= window_ && branch.blocks.back().count == block_length_;
  });
  if (!full) {
    return;
  }
  block_length_ *= 2;
  for (Branch& branch : branches_) {
    std::vector<Block> merged;
    for (const Block& block : branch.blocks) {
      if (merged.empty() || merged.back().count + block.count > block_length_) {
        merged.emplace_back();
      }
      merged.back().add(block);
    }
    branch.blocks = std::move(merged);
  }
}

std::span<const Dispersion::Block> Dispersion::closed_blocks(const Branch& branch) const {
  const std::span<const Block> all{branch.blocks};
  return all.back().count == block_length_ ? all : all.first(all.size() - 1);
}

Dispersion::Scatter Dispersion::scatter_of(std::span<const Block> blocks) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Block& block : blocks) {
    sum += block.axis_sum;
  }
  const Eigen::Vector3d middle = sum.normalized();
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(middle);
  constexpr int kUnknowns = 2 + kAllowedErrors;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  normal.diagonal().tail<kAllowedErrors>().setOnes();
  Unknowns right = Unknowns::Zero();
  double squares = 0.0;
  for (const Block& block : blocks) {
    const double count = block.count;
    const Eigen::Matrix<double, 2, kAllowedErrors> shift =
        basis.transpose() * block.shift_sum / count;
    const Eigen::Matrix2d covariance_rad2 =
        basis.transpose() * block.covariance_sum_rad2 * basis / (count * count) +
        kModelChange * kModelChange * shift * shift.transpose() +
        kFloor_rad * kFloor_rad * Eigen::Matrix2d::Identity();
    const Eigen::LDLT<Eigen::Matrix2d> weight{covariance_rad2};
    const Eigen::Vector2d off_rad = offset_rad(middle, block.axis_sum.normalized(), basis);
    Eigen::Matrix<double, 2, kUnknowns> design;
    design << Eigen::Matrix2d::Identity(), shift;
    const Eigen::Matrix<double, 2, kUnknowns> weighted = weight.solve(design);
    normal += design.transpose() * weighted;
    right += weighted.transpose() * off_rad;
    squares += off_rad.dot(weight.solve(off_rad));
  }
  return {.squares = std::max(squares - right.dot(normal.ldlt().solve(right)), 0.0),
          .half_freedom = static_cast<int>(blocks.size()) - 1};
}

bool Dispersion::nearly_linear() const {
  return std::all_of(branches_.begin(), branches_.end(), [](const Branch& branch) {
    const Block& last = branch.blocks.back();
    return last.covariance_sum_rad2.trace() < last.count * kNearlyLinear_rad * kNearlyLinear_rad;
  });
}

std::optional<StationaryBranch> Dispersion::steady() const {
  if (branches_.size() < 2) {
    return std::nullopt;
  }
  std::vector<Scatter> scatters;
  for (const Branch& branch : branches_) {
    const auto blocks = closed_blocks(branch);
    if (blocks.size() < kFewestBlocks) {
      return std::nullopt;
    }
    scatters.push_back(scatter_of(blocks));
  }
  const auto variance = [](const Scatter& s) { return s.squares / (2.0 * s.half_freedom); };
  const auto least = std::min_element(
      scatters.begin(), scatters.end(),
      [&](const Scatter& a, const Scatter& b) { return variance(a) < variance(b); });
  if (variance(*least) > kSteadyVariance) {
    return std::nullopt;
  }
  // A scatter below the noise only shows a cautious noise model, so the noise replaces it.
  const double noise = std::max(variance(*least), 1.0);
  const bool by_likelihood = !unlike_ && nearly_linear();
  double least_ratio = std::numeric_limits<double>::infinity();
  std::optional<double> log_likelihood_ratio;
  for (const Scatter& other : scatters) {
    if (&other == &*least) {
      continue;
    }
    const double ratio = variance(other) / noise;
    least_ratio = std::min(least_ratio, ratio);
    if (variance_ratio_tail(2.0 * other.half_freedom, 2.0 * least->half_freedom, ratio) < kLevel) {
      continue;
    }
    const double more_squares = other.squares - least->squares;
    if (!by_likelihood || more_squares <= kDecisive * noise) {
      return std::nullopt;
    }
    const double log_ratio = 0.5 * more_squares / noise;
    log_likelihood_ratio = std::min(log_ratio, log_likelihood_ratio.value_or(log_ratio));
  }
  Block whole;
  for (const Block& block : branches_[static_cast<std::size_t>(least - scatters.begin())].blocks) {
    whole.add(block);
  }
  return StationaryBranch{
      .axis = {.axis_icrf = whole.axis_sum.normalized(), .count = static_cast<double>(whole.count)},
      .scatter_ratio = least_ratio,
      .log_likelihood_ratio = log_likelihood_ratio};
}

}  // namespace spindrift
