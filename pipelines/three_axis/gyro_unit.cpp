#include "pipelines/three_axis/gyro_unit.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

void GyroUnit::observe(const GyroSample& sample) {
  if (is_heard_at(sample.t)) {
    turn_to(sample.t, 0.5 * (last_->rate_body_rad_s + sample.rate_body_rad_s));
  } else {
    fix_.reset();
    reached_ = sample.t;
  }
  last_ = sample;
}

void GyroUnit::observe(TaiTime t, const ObservedAttitude& fix) {
  if (!is_heard_at(t)) {
    fix_.reset();
    return;
  }
  turn_to(t, last_->rate_body_rad_s);
  // Longer turns are not integrated, because the bias would dominate.
  if (!fix_ || elapsed_s(fixed_, t) > 60.0) {
    begin(t, fix);
    return;
  }
  const Eigen::Quaterniond seen = fix_->conjugate() * fix.q_icrf_body;
  // A shorter turn between two fixes is not significant against their noise.
  if (rotation_vector_of(seen).norm() < 20.0 * fix.sigma_rad) {
    return;
  }
  if (const auto factor = factor_that_agrees(seen, fix.sigma_rad)) {
    in_a_row_ = *factor == factor_ ? 0 : in_a_row_ + 1;
    if (in_a_row_ >= 3) {
      factor_ = *factor;
      in_a_row_ = 0;
    }
  }
  begin(t, fix);
}

bool GyroUnit::is_heard_at(TaiTime t) const { return last_ && elapsed_s(last_->t, t) <= 2.5; }

void GyroUnit::begin(TaiTime t, const ObservedAttitude& fix) {
  fixed_ = t;
  fix_ = fix.q_icrf_body;
  turned_.fill(Eigen::Quaterniond::Identity());
}

void GyroUnit::turn_to(TaiTime t, const Eigen::Vector3d& rate_rad_s) {
  const Eigen::Vector3d turn_rad = elapsed_s(std::exchange(reached_, t), t) * rate_rad_s;
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    turned_[i] = (turned_[i] * quaternion_by(turn_rad / kFactors[i])).normalized();
  }
}

/// @return The factor of rad/s if it agrees, else another that agrees; empty if none does.
std::optional<double> GyroUnit::factor_that_agrees(const Eigen::Quaterniond& seen,
                                                   double sigma_rad) const {
  const double seen_rad = rotation_vector_of(seen).norm();
  // Tolerances for agreement of a turn: a fraction of it for rate changes between the samples, and
  // the noise of two fixes and of the bias, which three axes exceed with a probability of 0.001.
  const double left_rad = 0.05 * seen_rad + 4.0 * (std::numbers::sqrt2 * sigma_rad +
                                                   bias_sigma_rad_s_ * elapsed_s(fixed_, reached_));
  if (angle_between_rad(turned_.front(), seen) <= left_rad) {
    return kFactors.front();
  }
  std::optional<double> agrees;
  for (std::size_t i = 1; i < kFactors.size(); ++i) {
    // A larger misfit, as a fraction of the turn, is a disagreement whatever the bias. Otherwise
    // rates that another unit makes too small would agree with every slow turn.
    if (angle_between_rad(turned_[i], seen) <= std::min(left_rad, 0.5 * seen_rad)) {
      agrees = kFactors[i];
    }
  }
  return agrees;
}

}  // namespace spindrift
