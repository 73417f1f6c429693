#include "pipelines/reconstruction/gyro_screening.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "pipelines/statistics/significance.h"
#include "pipelines/three_axis/frozen_samples.h"
#include "pipelines/three_axis/gyro_outlier.h"
#include "pipelines/three_axis/gyro_watch.h"

namespace spindrift {
namespace {

constexpr std::size_t kFewest = 20;

/// Knows the step of the telemetry.
FrozenSamples watch_of(std::span<const GyroSample> samples) {
  FrozenSamples watch = FrozenSamples::of_gyro();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    watch.learn(samples[i - 1].rate_body_rad_s, samples[i].rate_body_rad_s);
  }
  return watch;
}

/// But for the first of each row that repeats.
std::vector<bool> frozen(std::span<const GyroSample> samples, FrozenSamples watch,
                         double noise_rad_s) {
  std::vector<bool> marked(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int row = watch.repeated(samples[i].rate_body_rad_s, noise_rad_s); row > 1; --row) {
      marked[i + 2 - static_cast<std::size_t>(row)] = true;
    }
  }
  return marked;
}

/// Its change by the less of those on either side.
bool is_outlier(std::span<const GyroSample> samples, std::size_t i, double noise_rad_s) {
  const GyroSample& before = samples[i - 1];
  const GyroSample& at = samples[i];
  const GyroSample& behind = samples[i + 1];
  Eigen::Vector3d change = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  if (i > 1) {
    change = change_rad_s(samples[i - 2], before, before.t, at.t);
  }
  if (i + 2 < samples.size()) {
    change = change.cwiseMin(change_rad_s(behind, samples[i + 2], at.t, behind.t));
  }
  return deviation(before.rate_body_rad_s, at.rate_body_rad_s, behind.rate_body_rad_s, change,
                   noise_rad_s)
      .stands_out();
}

std::vector<GyroSample> without_spikes(std::span<const GyroSample> samples, double noise_rad_s) {
  std::vector<GyroSample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool is_end = i == 0 || i + 1 == samples.size();
    if (is_end || !is_outlier(samples, i, noise_rad_s)) {
      kept.push_back(samples[i]);
    }
  }
  return kept;
}

/// How many at an end are off: all that are the same, as those of a gyro that has just been
/// switched on.
template <class Iterator>
std::ptrdiff_t off_at_end(Iterator first, Iterator last, double noise_rad_s) {
  const auto next = std::find_if(first, last, [&](const GyroSample& sample) {
    return sample.rate_body_rad_s != first->rate_body_rad_s;
  });
  if (std::distance(next, last) < 2) {
    return 0;
  }
  const bool is_off =
      deviation_at_end(*std::prev(next), *next, *std::next(next), noise_rad_s).stands_out();
  return is_off ? std::distance(first, next) : 0;
}

void leave_out_outliers(ScreenedGyro& gyro, double noise_rad_s) {
  std::vector<GyroSample> kept = without_spikes(gyro.usable, noise_rad_s);
  const std::ptrdiff_t at_end = off_at_end(kept.rbegin(), kept.rend(), noise_rad_s);
  kept.erase(kept.end() - at_end, kept.end());
  const std::ptrdiff_t at_start = off_at_end(kept.begin(), kept.end(), noise_rad_s);
  kept.erase(kept.begin(), kept.begin() + at_start);
  gyro.first_is_outlier = at_start > 0;
  gyro.outliers = std::ssize(gyro.usable) - std::ssize(kept);
  gyro.usable = std::move(kept);
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
  const FrozenSamples watch = watch_of(samples);
  const std::vector<bool> repeats = frozen(samples, watch, sensor.noise_rad_s);
  ScreenedGyro result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (is_saturated(samples[i], sensor)) {
      ++result.saturated;
    } else if (repeats[i]) {
      ++result.frozen;
    } else {
      result.usable.push_back(samples[i]);
    }
  }
  result.noise = noise_of(result.usable, sensor.noise_rad_s);
  leave_out_outliers(
      result,
      std::max(sensor.noise_rad_s * std::max(1.0, result.noise.value_or(1.0)), 0.5 * watch.step()));
  return result;
}

}  // namespace spindrift
