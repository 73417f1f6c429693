#include "pipelines/three_axis/gyro_screening.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"
#include "pipelines/three_axis/frozen_samples.h"
#include "pipelines/three_axis/gyro_tests.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr std::size_t kFewest = 20;

/// Returns a detector that knows the quantisation step of the telemetry.
FrozenSamples watch_of(std::span<const GyroSample> samples) {
  FrozenSamples watch = FrozenSamples::of_gyro();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    watch.learn(samples[i - 1].rate_body_rad_s, samples[i].rate_body_rad_s);
  }
  return watch;
}

/// Marks all but the first sample of each run of repeats, judged by the length of the whole run.
std::vector<std::optional<FailedTest>> frozen(std::span<const GyroSample> samples,
                                              FrozenSamples watch, double noise_rad_s) {
  std::vector<std::optional<FailedTest>> failed(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int row = watch.repeated(samples[i].rate_body_rad_s, noise_rad_s); row > 1; --row) {
      failed[i + 2 - static_cast<std::size_t>(row)] = watch.failed();
    }
  }
  return failed;
}

void leave_out_spikes(ScreenedGyro& gyro, double noise_rad_s) {
  std::vector<GyroSample> kept;
  for (std::size_t i = 0; i < gyro.usable.size(); ++i) {
    const bool is_end = i == 0 || i + 1 == gyro.usable.size();
    const auto off = is_end ? std::nullopt : std::optional{deviation(gyro.usable, i, noise_rad_s)};
    if (off && off->stands_out()) {
      gyro.left_out.push_back(outlier(gyro.usable[i], *off));
    } else {
      kept.push_back(gyro.usable[i]);
    }
  }
  gyro.usable = std::move(kept);
}

/// Rejects outliers at one end and returns their number. Equal samples there are rejected together,
/// as from a gyro that has just been switched on.
/// @param left_out Receives the rejected samples.
template <class Iterator>
std::ptrdiff_t leave_out_at_end(Iterator first, Iterator last, double noise_rad_s,
                                std::vector<RejectedSample>& left_out) {
  const auto next = std::find_if(first, last, [&](const GyroSample& sample) {
    return sample.rate_body_rad_s != first->rate_body_rad_s;
  });
  if (std::distance(next, last) < 2) {
    return 0;
  }
  const GyroDeviation off =
      deviation_at_end(*std::prev(next), *next, *std::next(next), noise_rad_s);
  if (!off.stands_out()) {
    return 0;
  }
  std::transform(first, next, std::back_inserter(left_out),
                 [&](const GyroSample& sample) { return outlier(sample, off); });
  return std::distance(first, next);
}

void leave_out_outliers(ScreenedGyro& gyro, double noise_rad_s) {
  leave_out_spikes(gyro, noise_rad_s);
  std::vector<GyroSample>& kept = gyro.usable;
  const auto at_end = leave_out_at_end(kept.rbegin(), kept.rend(), noise_rad_s, gyro.left_out);
  kept.erase(kept.end() - at_end, kept.end());
  const auto at_start = leave_out_at_end(kept.begin(), kept.end(), noise_rad_s, gyro.left_out);
  kept.erase(kept.begin(), kept.begin() + at_start);
  gyro.first_is_outlier = at_start > 0;
}

/// Uses evenly spaced samples only, because the rate may not be linear across a gap.
std::optional<double> noise_of(std::span<const GyroSample> samples, double noise_rad_s) {
  std::vector<double> deviations;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const double before_s = elapsed_s(samples[i - 1].t, samples[i].t);
    const double behind_s = elapsed_s(samples[i].t, samples[i + 1].t);
    if (std::abs(behind_s - before_s) < 0.1 * before_s) {
      const OffLine line = off_line(samples[i + 1], samples[i], samples[i - 1]);
      std::transform(line.off_rad_s.begin(), line.off_rad_s.end(), std::back_inserter(deviations),
                     [&](double value) { return std::abs(value) / line.spread; });
    }
  }
  if (deviations.size() < 3 * kFewest) {
    return std::nullopt;
  }
  return upper_median(deviations) / kMedianDeviation / noise_rad_s;
}

}  // namespace

ScreenedGyro screened(std::span<const GyroSample> samples, const GyroSensor& sensor) {
  const FrozenSamples watch = watch_of(samples);
  const auto repeats = frozen(samples, watch, sensor.noise_rad_s);
  ScreenedGyro result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (const auto rejected = rejected_alone(samples[i], sensor, repeats[i])) {
      result.left_out.push_back(*rejected);
    } else {
      result.usable.push_back(samples[i]);
    }
  }
  result.noise = noise_of(result.usable, sensor.noise_rad_s);
  const double noise_rad_s = sensor.noise_rad_s * std::max(1.0, result.noise.value_or(1.0));
  leave_out_outliers(result, noise_or_step_rad_s(noise_rad_s, watch.step()));
  std::sort(result.left_out.begin(), result.left_out.end(),
            [](const RejectedSample& a, const RejectedSample& b) { return a.t < b.t; });
  return result;
}

}  // namespace spindrift
