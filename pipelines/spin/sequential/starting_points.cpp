#include "pipelines/spin/sequential/starting_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// A worse known axis is no place to linearise: the filter would take the difference between two
// linearisations for knowledge that no edge gives.
constexpr double kPoorest_rad = 3.0 * kRadPerDeg;

StartingPoint middle_of(const MeanAxis& branch) {
  const Eigen::Matrix2d alignment_rad2 = branch.alignment_rad2();
  return {.axis_icrf = branch.axis_icrf(),
          .covariance_rad2 = branch.covariance_rad2() + alignment_rad2,
          .alignment_rad2 = alignment_rad2};
}

}  // namespace

bool leaves_open(const SpinFix& fix) {
  return fix.resolution == Resolution::Ambiguous || fix.resolution == Resolution::Prior;
}

std::vector<StartingPoint> candidates_of(const SpinFix& fix) {
  std::vector<StartingPoint> candidates{{fix.axis_icrf, fix.covariance_rad2, fix.alignment_rad2}};
  if (leaves_open(fix)) {
    for (const SpinAlternate& alternate : fix.alternates) {
      candidates.push_back(
          {alternate.axis_icrf, alternate.covariance_rad2, alternate.alignment_rad2});
    }
  }
  return candidates;
}

bool well_known(const Eigen::Matrix2d& covariance_rad2) {
  return covariance_rad2.trace() < kPoorest_rad * kPoorest_rad;
}

bool contradict(const StartingPoint& one, const StartingPoint& other) {
  const Eigen::Vector3d& axis = other.axis_icrf;
  const double apart_rad = angle_between_rad(axis, one.axis_icrf);
  const Eigen::Vector2d towards = tangent_basis(axis).transpose() * (one.axis_icrf - axis);
  const double length = towards.norm();
  if (apart_rad <= kModelLimit_rad || !(length > 0.0)) {
    return apart_rad > kModelLimit_rad;
  }
  const Eigen::Vector2d apart = towards * (apart_rad / length);
  const Eigen::Matrix2d covariance = one.covariance_rad2 + other.covariance_rad2;
  return apart.dot(covariance.ldlt().solve(apart)) > kContradictionSigmas * kContradictionSigmas;
}

std::optional<StartingPoints::Known> StartingPoints::add(
    std::span<const StartingPoint> candidates) {
  // Fixes that have named this many branches do not agree on an axis.
  if (branches_.size() > 16) {
    forget();
  }
  ++fixes_;
  Known known{.points = {}, .fixes = fixes_};
  std::vector<std::size_t> taken;
  for (const StartingPoint& candidate : candidates) {
    const std::size_t branch = branch_of(candidate, taken);
    branches_.resize(std::max(branches_.size(), branch + 1));
    branches_[branch].add_fix(candidate.axis_icrf, candidate.covariance_rad2,
                              candidate.alignment_rad2);
    taken.push_back(branch);
    known.points.push_back(middle_of(branches_[branch]));
  }
  if (fixes_ < fewest_ ||
      !std::all_of(known.points.begin(), known.points.end(),
                   [](const StartingPoint& point) { return well_known(point.covariance_rad2); })) {
    return std::nullopt;
  }
  return known;
}

void StartingPoints::forget() {
  branches_.clear();
  fixes_ = 0;
}

/// Returns the nearest branch that agrees with the candidate and that no other candidate of the fix
/// has taken; else a new one.
std::size_t StartingPoints::branch_of(const StartingPoint& candidate,
                                      const std::vector<std::size_t>& taken) const {
  std::size_t nearest = branches_.size();
  double least_rad = std::numbers::pi;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const bool free = std::find(taken.begin(), taken.end(), i) == taken.end();
    const double apart_rad = angle_between_rad(branches_[i].axis_icrf(), candidate.axis_icrf);
    if (free && apart_rad < least_rad && !contradict(candidate, middle_of(branches_[i]))) {
      nearest = i;
      least_rad = apart_rad;
    }
  }
  return nearest;
}

}  // namespace spindrift
