#include "pipelines/three_axis/frozen_gyro.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace spindrift {
namespace {

constexpr double kByChance = 1e-9;
// Fewer bend the attitude by little, whatever the gyro did.
constexpr double kFewestFrozen = 5.0;
// A gyro may be so much quieter than stated.
constexpr double kQuieter = 3.0;
constexpr std::array<Eigen::Index, 3> kAxes{0, 1, 2};

/// All axes, then each.
std::span<const Eigen::Index> axes_of(std::size_t row) {
  const std::span<const Eigen::Index> all{kAxes};
  return row == 0 ? all : all.subspan(row - 1, 1);
}

}  // namespace

void FrozenGyro::learn(const Eigen::Vector3d& earlier_rad_s, const Eigen::Vector3d& later_rad_s) {
  for (const Eigen::Index axis : kAxes) {
    const double step_rad_s = std::abs(later_rad_s[axis] - earlier_rad_s[axis]);
    auto& least = steps_rad_s_[static_cast<std::size_t>(axis)];
    if (step_rad_s > 0.0) {
      least = std::min(least.value_or(step_rad_s), step_rad_s);
    }
  }
}

int FrozenGyro::repeated(const Eigen::Vector3d& rate_rad_s) {
  int longest = 0;
  for (std::size_t row = 0; row < in_a_row_.size(); ++row) {
    const auto axes = axes_of(row);
    const bool same = last_rad_s_ && std::all_of(axes.begin(), axes.end(), [&](Eigen::Index axis) {
                        return rate_rad_s[axis] == (*last_rad_s_)[axis];
                      });
    in_a_row_[row] = same ? in_a_row_[row] + 1 : 1;
    if (same && in_a_row_[row] > longest_by_chance(axes)) {
      longest = std::max(longest, in_a_row_[row]);
    }
  }
  last_rad_s_ = rate_rad_s;
  return longest;
}

/// Of an axis that never changed that of the others; 0: none ever did.
double FrozenGyro::step_of_rad_s(Eigen::Index axis) const {
  const auto& own = steps_rad_s_[static_cast<std::size_t>(axis)];
  const auto* const finest =
      std::min_element(steps_rad_s_.begin(), steps_rad_s_.end(),
                       [](const auto& a, const auto& b) { return a && (!b || *a < *b); });
  return own.value_or(finest->value_or(0.0));
}

double FrozenGyro::step_rad_s() const {
  double coarsest_rad_s = 0.0;
  for (const Eigen::Index axis : kAxes) {
    coarsest_rad_s = std::max(coarsest_rad_s, step_of_rad_s(axis));
  }
  return coarsest_rad_s;
}

/// That a sample repeats the one before it is that two normal values fall on one step.
double FrozenGyro::longest_by_chance(Axes axes) const {
  double chance = 1.0;
  for (const Eigen::Index axis : axes) {
    const double steps =
        step_of_rad_s(axis) * kQuieter / (2.0 * noise_rad_s_ * std::sqrt(std::numbers::pi));
    chance *= std::min(steps, 1.0);
  }
  if (chance >= 1.0) {
    return std::numeric_limits<double>::infinity();
  }
  if (chance == 0.0) {
    return kFrozenInARow - 1.0;
  }
  return std::max(1.0 + std::log(kByChance) / std::log(chance), kFewestFrozen - 1.0);
}

}  // namespace spindrift
