#include "pipelines/reconstruction/gyro_screening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

constexpr std::size_t kFewest = 20;
/// Fewer than that bend the attitude by little, whatever the gyro did.
constexpr double kFewestFrozen = 5.0;

/// Smallest step between neighbours that there is, of an axis; 0 where it never changes.
double grid_rad_s(std::span<const GyroSample> samples, Eigen::Index axis) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step =
        std::abs(samples[i].rate_body_rad_s[axis] - samples[i - 1].rate_body_rad_s[axis]);
    smallest = step > 0.0 ? std::min(smallest, step) : smallest;
  }
  return std::isfinite(smallest) ? smallest : 0.0;
}

using Axes = std::span<const Eigen::Index>;

/// That a sample repeats the one before it about these axes: two normal values on one step of the
/// grid. A gyro may be three times as quiet as stated.
double chance_of_repeat(std::span<const GyroSample> samples, Axes axes, double noise_rad_s) {
  double chance = 1.0;
  for (const Eigen::Index axis : axes) {
    const double steps =
        grid_rad_s(samples, axis) / (2.0 / 3.0 * noise_rad_s * std::sqrt(std::numbers::pi));
    chance *= std::min(steps, 1.0);
  }
  return chance;
}

/// So many samples in a row may be the same about these axes.
double longest_by_chance(std::span<const GyroSample> samples, Axes axes, double noise_rad_s) {
  const double chance = chance_of_repeat(samples, axes, noise_rad_s);
  if (chance >= 1.0) {
    return std::numeric_limits<double>::infinity();
  }
  const double rows = kFalseAlarm / static_cast<double>(samples.size());
  const double longest = chance > 0.0 ? 1.0 + std::log(rows) / std::log(chance) : 1.0;
  return std::max(longest, kFewestFrozen - 1.0);
}

/// Marks those behind the first of a row that is too long.
void mark_frozen(std::span<const GyroSample> samples, Axes axes, double noise_rad_s,
                 std::vector<bool>& frozen) {
  const double longest = longest_by_chance(samples, axes, noise_rad_s);
  const auto repeats = [&](std::size_t i, std::size_t first) {
    return std::all_of(axes.begin(), axes.end(), [&](Eigen::Index axis) {
      return samples[i].rate_body_rad_s[axis] == samples[first].rate_body_rad_s[axis];
    });
  };
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < samples.size(); begin = end) {
    end = begin + 1;
    while (end < samples.size() && repeats(end, begin)) {
      ++end;
    }
    for (std::size_t i = begin + 1; i<end&& static_cast<double>(end - begin)> longest; ++i) {
      frozen[i] = true;
    }
  }
}

bool is_saturated(const GyroSample& sample, const GyroSensor& sensor) {
  return sensor.range_rad_s &&
         !(sample.rate_body_rad_s.cwiseAbs().maxCoeff() < *sensor.range_rad_s);
}

/// Only where the step before is as long as that behind: elsewhere the rate may do anything.
std::optional<double> noise_of(std::span<const GyroSample> samples, double noise_rad_s) {
  constexpr double kEven = 0.1;
  std::vector<double> deviations;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double before_s = seconds_between(samples[i - 1].t, samples[i].t);
    const double behind_s = seconds_between(samples[i].t, samples[i + 1].t);
    if (std::abs(behind_s - before_s) < kEven * before_s) {
      const Eigen::Vector3d off = samples[i - 1].rate_body_rad_s -
                                  2.0 * samples[i].rate_body_rad_s + samples[i + 1].rate_body_rad_s;
      std::transform(off.begin(), off.end(), std::back_inserter(deviations),
                     [](double value) { return std::abs(value) / std::sqrt(6.0); });
    }
  }
  if (deviations.size() < 3 * kFewest) {
    return std::nullopt;
  }
  const auto middle = deviations.begin() + std::ssize(deviations) / 2;
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle / kMedianDeviation / noise_rad_s;
}

}  // namespace

ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor) {
  constexpr std::array<Eigen::Index, 3> kAll{0, 1, 2};
  std::vector<bool> frozen(samples.size());
  mark_frozen(samples, kAll, sensor.noise_rad_s, frozen);
  for (const Eigen::Index axis : kAll) {
    mark_frozen(samples, {&axis, 1}, sensor.noise_rad_s, frozen);
  }
  ScreenedGyro result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (is_saturated(samples[i], sensor)) {
      ++result.saturated;
    } else if (frozen[i]) {
      ++result.frozen;
    } else {
      result.usable.push_back(samples[i]);
    }
  }
  result.noise = noise_of(result.usable, sensor.noise_rad_s);
  return result;
}

}  // namespace spindrift
