#include "pipelines/three_axis/gyro_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kRecentInterval = 0.1;
constexpr double kGap = 1.5;  // In usual intervals.
// Step of the noise estimate per axis and sample; the estimate settles within some ten samples.
constexpr double kRecentNoise = 0.05;

}  // namespace

std::optional<RejectedSample> GyroWatch::judge(const GyroSample& sample) {
  const bool was_out = out_because_.has_value();
  const bool is_frozen = frozen_.learn_and_test(sample.rate_body_rad_s, sensor_.noise_rad_s) > 0;
  auto rejected =
      rejected_alone(sample, sensor_, is_frozen ? std::optional{frozen_.failed()} : std::nullopt);
  out_because_ = rejected ? std::optional{rejected->rejected_by} : std::nullopt;
  if (out_because_ && !was_out) {
    out_since_ = sample.t;
  }
  return rejected;
}

std::optional<GyroDeviation> GyroWatch::deviation_from_line(const GyroSample& sample) const {
  return before_last_
             ? std::optional{deviation_at_end(sample, *last_, *before_last_, scatter_rad_s())}
             : std::nullopt;
}

GyroDeviation GyroWatch::deviation_from_both(const GyroSample& suspect,
                                             const GyroSample& next) const {
  return deviation(std::array{*before_last_, *last_, suspect, next}, 2, scatter_rad_s());
}

double GyroWatch::scatter_rad_s() const {
  return noise_or_step_rad_s(noise_rad_s_, frozen_.step());
}

void GyroWatch::accept(const GyroSample& sample) {
  wander_.track(sample.t, sample.rate_body_rad_s);
  if (last_) {
    note_interval(elapsed_s(last_->t, sample.t));
  }
  if (before_last_) {
    note_noise(sample);
  }
  before_last_ = last_;
  last_ = sample;
}

void GyroWatch::note_interval(double interval_s) {
  intervals_ += 1.0;
  usual_interval_s_ +=
      std::max(kRecentInterval, 1.0 / intervals_) *
      ((is_gap(interval_s) ? kGap * usual_interval_s_ : interval_s) - usual_interval_s_);
}

/// Tracks the median of the deviations: at the median, as many are above as below.
void GyroWatch::note_noise(const GyroSample& sample) {
  const OffLine line = off_line(sample, *last_, *before_last_);
  for (const double off : line.off_rad_s) {
    const bool is_more = std::abs(off) > kMedianDeviation * line.spread * noise_rad_s_;
    noise_rad_s_ *= is_more ? 1.0 + kRecentNoise : 1.0 - kRecentNoise;
  }
  noise_rad_s_ = std::max(noise_rad_s_, sensor_.noise_rad_s);
}

bool GyroWatch::is_gap(double interval_s) const {
  return intervals_ > 1.0 && interval_s > kGap * usual_interval_s_;
}

}  // namespace spindrift
