#include "pipelines/three_axis/gyro_watch.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "pipelines/statistics/significance.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kRecentInterval = 0.1;
constexpr double kGap = 1.5;        // Usual intervals.
constexpr double kClipped = 0.999;  // Of the range.
// Of the noise, of each axis of a sample: it comes to the median within some ten samples.
constexpr double kRecentNoise = 0.05;

}  // namespace

bool is_saturated(const GyroSample& sample, const GyroSensor& sensor) {
  return sensor.range_rad_s &&
         sample.rate_body_rad_s.cwiseAbs().maxCoeff() >= kClipped * *sensor.range_rad_s;
}

std::optional<Rejection> GyroWatch::judge(const GyroSample& sample) {
  const bool was_out = out_because_.has_value();
  const bool is_frozen = frozen_.note(sample.rate_body_rad_s, sensor_.noise_rad_s) > 0;
  if (is_saturated(sample, sensor_)) {
    out_because_ = Rejection::Saturated;
  } else if (is_frozen) {
    out_because_ = Rejection::Frozen;
  } else {
    out_because_ = std::nullopt;
  }
  if (out_because_ && !was_out) {
    out_since_ = sample.t;
  }
  return out_because_;
}

FailedTest GyroWatch::failed(const GyroSample& sample) const {
  if (out_because_ == Rejection::Saturated) {
    return {.value = sample.rate_body_rad_s.cwiseAbs().maxCoeff(),
            .limit = kClipped * sensor_.range_rad_s.value()};
  }
  return {.value = static_cast<double>(frozen_.repeats()), .limit = frozen_.most_by_chance()};
}

std::optional<GyroDeviation> GyroWatch::deviation_from_line(const GyroSample& sample) const {
  return before_last_
             ? std::optional{deviation_at_end(sample, *last_, *before_last_, scatter_rad_s())}
             : std::nullopt;
}

GyroDeviation GyroWatch::deviation_from_both(const GyroSample& suspect,
                                             const GyroSample& next) const {
  return deviation(last_->rate_body_rad_s, suspect.rate_body_rad_s, next.rate_body_rad_s,
                   change_rad_s(*before_last_, *last_, last_->t, suspect.t), scatter_rad_s());
}

double GyroWatch::scatter_rad_s() const { return std::max(noise_rad_s_, 0.5 * frozen_.step()); }

void GyroWatch::accept(const GyroSample& sample) {
  wander_.note(sample.t, sample.rate_body_rad_s);
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

/// Of the median: as many deviations are above as below it.
void GyroWatch::note_noise(const GyroSample& sample) {
  const double share = elapsed_s(last_->t, sample.t) / elapsed_s(before_last_->t, last_->t);
  const Eigen::Vector3d off_rad_s =
      sample.rate_body_rad_s - last_->rate_body_rad_s -
      share * (last_->rate_body_rad_s - before_last_->rate_body_rad_s);
  const double spread = std::sqrt(1.0 + (1.0 + share) * (1.0 + share) + share * share);
  for (const double off : off_rad_s) {
    const bool is_more = std::abs(off) > kMedianDeviation * spread * noise_rad_s_;
    noise_rad_s_ *= is_more ? 1.0 + kRecentNoise : 1.0 - kRecentNoise;
  }
  noise_rad_s_ = std::max(noise_rad_s_, sensor_.noise_rad_s);
}

bool GyroWatch::is_gap(double interval_s) const {
  return intervals_ > 1.0 && interval_s > kGap * usual_interval_s_;
}

}  // namespace spindrift
