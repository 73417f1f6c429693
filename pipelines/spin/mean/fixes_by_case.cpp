#include "pipelines/spin/mean/fixes_by_case.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

namespace spindrift {

double largest_selection_shift_sigmas(double share) {
  const double left_out = 1.0 - share;
  if (!(left_out > 0.0)) {
    return 0.0;
  }
  return std::min(std::sqrt(-2.0 * std::log(share)),
                  left_out / share * std::sqrt(-2.0 * std::log(left_out)));
}

FixesByCase::Group& FixesByCase::Group::operator+=(const Group& other) {
  equations += other.equations;
  count += other.count;
  left_out += other.left_out;
  return *this;
}

double FixesByCase::Group::share() const {
  return static_cast<double>(count) / static_cast<double>(count + left_out);
}

std::int64_t FixesByCase::next_stretch(int geometry_case) {
  Open& open =
      open_.try_emplace(geometry_case, Open{.last = empty(), .before = empty()}).first->second;
  if (open.last.count + open.last.left_out >= stretch_fixes_) {
    close(open.before);
    open = {.number = open.number + 1, .last = empty(), .before = open.last};
  }
  return open.number;
}

FixesByCase::Group& FixesByCase::group_of(int geometry_case, std::int64_t stretch) {
  Open& open = open_.at(geometry_case);
  return stretch == open.number ? open.last : open.before;
}

void FixesByCase::close(const Group& stretch) {
  if (stretch.count == 0) {
    return;
  }
  const auto* const alike = std::find_if(
      kShares.begin(), kShares.end(), [&](double at_least) { return stretch.share() >= at_least; });
  closed_[static_cast<std::size_t>(alike - kShares.begin())] += stretch;
}

void FixesByCase::leave_out(int geometry_case, std::int64_t stretch) {
  ++group_of(geometry_case, stretch).left_out;
}

void FixesByCase::take_back(int geometry_case, std::int64_t stretch) {
  --group_of(geometry_case, stretch).left_out;
}

void FixesByCase::add_fix(int geometry_case, std::int64_t stretch, const SpinConfig& config,
                          const RevolutionMeasurements& measured,
                          const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf) {
  Group& group = group_of(geometry_case, stretch);
  group.equations.add(config, measured, sun_earth, axis_icrf);
  ++group.count;
}

void FixesByCase::begin_at(const Eigen::Vector3d& reference_icrf) {
  reference_icrf_ = reference_icrf;
  const auto forget = [&](Group& group) {
    group.equations = AngleEquations{reference_icrf};
    group.count = 0;
  };
  for (auto& [geometry_case, open] : open_) {
    forget(open.last);
    forget(open.before);
  }
  closed_.assign(kShares.size(), empty());
}

/// Merges the open stretches of each case, since the settled share of a few fixes means little.
std::vector<FixesByCase::Group> FixesByCase::groups() const {
  std::vector<Group> all;
  all.reserve(closed_.size() + open_.size());
  const auto has_fixes = [](const Group& group) { return group.count > 0; };
  std::copy_if(closed_.begin(), closed_.end(), std::back_inserter(all), has_fixes);
  for (const auto& [geometry_case, open] : open_) {
    if (has_fixes(open.before) || has_fixes(open.last)) {
      all.push_back(open.before);
      all.back() += open.last;
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Group& a, const Group& b) { return a.share() > b.share(); });
  return all;
}

MeanOfCases FixesByCase::mean() const {
  AngleEquations equations{reference_icrf_};
  Eigen::Matrix2d shifts = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d settled = Eigen::Matrix2d::Zero();
  std::size_t count = 0;
  std::optional<MeanOfCases> best;
  for (const Group& group : groups()) {
    const Eigen::Matrix2d information = group.equations.normal().topLeftCorner<2, 2>();
    const double shift_sigmas = largest_selection_shift_sigmas(group.share());
    equations += group.equations;
    count += group.count;
    shifts += shift_sigmas * shift_sigmas * static_cast<double>(group.count) * information;
    settled += group.share() * information;
    const Eigen::Matrix2d noise_rad2 = equations.covariance_rad2();
    const Eigen::Matrix2d covariance_rad2 = noise_rad2 + equations.scatter_rad2(shifts);
    if (!best || covariance_rad2.trace() < best->covariance_rad2.trace()) {
      best = MeanOfCases{
          .equations = equations,
          .covariance_rad2 = covariance_rad2,
          .count = count,
          .settled_share = equations.scatter_rad2(settled).trace() / noise_rad2.trace()};
    }
  }
  return *best;
}

}  // namespace spindrift
