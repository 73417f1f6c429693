#include "pipelines/three_axis/gyro_watch.h"

#include <algorithm>
#include <cmath>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// Over which the rate's changes are taken: a body's rate is smooth within it, and its changes from
// sample to sample would not add up to those of a gap.
constexpr double kApart_s = 1.0;
constexpr double kMemory_s = 10.0;
constexpr double kRecentInterval = 0.1;
constexpr double kGap = 1.5;  // Usual intervals.

}  // namespace

std::optional<SampleRejection> GyroWatch::judge(const GyroSample& sample) {
  repeats_ = sample.rate_body_rad_s == repeated_rad_s_ ? repeats_ + 1 : 1;
  repeated_rad_s_ = sample.rate_body_rad_s;
  if (sensor_.range_rad_s && sample.rate_body_rad_s.cwiseAbs().maxCoeff() >= *sensor_.range_rad_s) {
    out_because_ = SampleRejection::Saturated;
  } else if (repeats_ >= kFrozenInARow) {
    out_because_ = SampleRejection::Frozen;
  } else {
    out_because_ = std::nullopt;
    note(sample);
    last_ = sample;
  }
  return out_because_;
}

void GyroWatch::note(const GyroSample& sample) {
  if (!last_) {
    a_second_ago_ = sample;
    return;
  }
  const double interval_s = elapsed_s(last_->t, sample.t);
  intervals_ += 1.0;
  usual_interval_s_ +=
      std::max(kRecentInterval, 1.0 / intervals_) *
      ((is_gap(interval_s) ? kGap * usual_interval_s_ : interval_s) - usual_interval_s_);

  const double apart_s = elapsed_s(a_second_ago_.t, sample.t);
  if (apart_s < kApart_s) {
    return;
  }
  const double changed_rad2_s2 =
      (sample.rate_body_rad_s - a_second_ago_.rate_body_rad_s).squaredNorm() / 3.0;
  const double noise_rad2_s2 = 2.0 * sensor_.noise_rad_s * sensor_.noise_rad_s;
  wander_rad2_s3_ += (1.0 - std::exp(-apart_s / kMemory_s)) *
                     ((changed_rad2_s2 - noise_rad2_s2) / apart_s - wander_rad2_s3_);
  a_second_ago_ = sample;
}

bool GyroWatch::is_gap(double interval_s) const {
  return intervals_ > 1.0 && interval_s > kGap * usual_interval_s_;
}

double GyroWatch::wander_rad2_s3() const { return std::max(0.0, wander_rad2_s3_); }

}  // namespace spindrift
