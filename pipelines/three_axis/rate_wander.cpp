#include "pipelines/three_axis/rate_wander.h"

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"

namespace spindrift {

void RateWander::track(TaiTime t, const Eigen::Vector3d& rate_rad_s) {
  const double apart_s = a_second_ago_ ? std::abs(seconds_between(a_second_ago_->t, t)) : 0.0;
  // Interval over which changes of rate are taken. The rate is smooth within it, and changes from
  // one sample to the next would not add up to the change across a gap.
  if (a_second_ago_ && apart_s < 1.0) {
    return;
  }
  if (a_second_ago_) {
    const double changed_rad2_s2 = (rate_rad_s - a_second_ago_->rad_s).squaredNorm() / 3.0;
    const double noise_rad2_s2 = 2.0 * noise_rad_s_ * noise_rad_s_;
    rad2_s3_ += (1.0 - std::exp(-apart_s / 10.0)) *
                ((changed_rad2_s2 - noise_rad2_s2) / apart_s - rad2_s3_);
  }
  a_second_ago_ = Rate{t, rate_rad_s};
}

/// The floor of the density is 1 deg in a minute.
double RateWander::rad2_s3() const { return std::max(1.4e-5 * kRadPerDeg * kRadPerDeg, rad2_s3_); }

}  // namespace spindrift
