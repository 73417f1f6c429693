#include "pipelines/reconstruction/rate_track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/statistics/median.h"
#include "pipelines/three_axis/rate_wander.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Returns the density of each step, the larger of those before and after it. The first and last
/// elements are for the times before the first sample and after the last one.
std::vector<double> wander_rad2_s3(std::span<const TimedRate> samples, double noise_rad_s) {
  std::vector<double> wander(samples.size() + 1);
  RateWander forwards{noise_rad_s};
  RateWander backwards{noise_rad_s};
  const auto note = [&](RateWander& by, const TimedRate& sample, double& beside) {
    by.track(shifted(TaiTime{}, sample.t_s), sample.rate_body_rad_s);
    beside = std::max(beside, by.rad2_s3());
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    note(forwards, samples[i], wander[i + 1]);
  }
  for (std::size_t i = samples.size(); i-- > 0;) {
    note(backwards, samples[i], wander[i]);
  }
  return wander;
}

}  // namespace

double usual_step_s(std::span<const TimedRate> samples) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    steps_s.push_back(samples[i].t_s - samples[i - 1].t_s);
  }
  return upper_median(steps_s);
}

RateTrack::RateTrack(std::vector<TimedRate> samples, double begin_s, double end_s,
                     double noise_rad_s)
    : samples_{std::move(samples)} {
  const double longest_s = 1.75 * usual_step_s(samples_);
  const std::vector<double> wander = wander_rad2_s3(samples_, noise_rad_s);
  const bool held_before = begin_s < samples_.front().t_s;
  const bool held_behind = end_s > samples_.back().t_s;
  if (held_before) {
    const TimedRate first = samples_.front();
    const double held_s = first.t_s - begin_s;
    const auto mirrored =
        std::find_if(samples_.begin(), samples_.end() - 1,
                     [&](const TimedRate& s) { return s.t_s >= first.t_s + held_s; });
    start_variance_rad2_s2_ =
        (mirrored->rate_body_rad_s - first.rate_body_rad_s).squaredNorm() + wander.front() * held_s;
    samples_.insert(samples_.begin(), {begin_s, first.rate_body_rad_s});
  }
  if (held_behind) {
    samples_.push_back({end_s, samples_.back().rate_body_rad_s});
  }
  const auto step_s = [&](std::size_t i) {
    return i + 1 < samples_.size() ? samples_[i + 1].t_s - samples_[i].t_s : 0.0;
  };
  for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
    const double h_s = step_s(i);
    const double weight_s = 0.5 * ((i > 0 ? step_s(i - 1) : 0.0) + 2.0 * h_s + step_s(i + 1));
    Step& step =
        steps_.emplace_back(Step{0.5 * weight_s * noise_rad_s * noise_rad_s, Matrix3d::Zero()});
    const bool is_last = held_behind && i + 2 == samples_.size();
    if (held_before && i == 0) {
      step.gap_rad2 = h_s * h_s / 3.0 * start_variance_rad2_s2_ * Matrix3d::Identity();
    } else if (is_last || h_s > longest_s) {
      const Vector3d change = samples_[i + 1].rate_body_rad_s - samples_[i].rate_body_rad_s;
      step.gap_rad2 =
          h_s * h_s / 12.0 *
          (change * change.transpose() +
           (is_last ? 4.0 : 1.0) * wander[i + (held_before ? 0 : 1)] * h_s * Matrix3d::Identity());
    }
    if (h_s > longest_s) {
      ++gaps_;
      longest_gap_s_ = std::max(longest_gap_s_, h_s);
    }
  }
}

std::size_t RateTrack::step_at(double t_s) const {
  const auto behind = std::upper_bound(samples_.begin(), samples_.end(), t_s,
                                       [](double t, const TimedRate& s) { return t < s.t_s; });
  const std::ptrdiff_t step = std::distance(samples_.begin(), behind) - 1;
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(step, 0, std::max<std::ptrdiff_t>(std::ssize(steps_) - 1, 0)));
}

Vector3d RateTrack::rate_in(std::size_t step, double t_s) const {
  const TimedRate& a = samples_[step];
  const TimedRate& b = samples_[step + 1];
  const double part = (t_s - a.t_s) / (b.t_s - a.t_s);
  return a.rate_body_rad_s + part * (b.rate_body_rad_s - a.rate_body_rad_s);
}

Vector3d RateTrack::rate_at(double t_s) const {
  return steps_.empty() ? samples_.front().rate_body_rad_s : rate_in(step_at(t_s), t_s);
}

PerTurnError Turn::per_error() const {
  PerTurnError slopes;
  slopes << per_bias_s, per_gyro_error;
  return slopes;
}

/// Integrates a linear rate by the Magnus series to fourth order.
void RateTrack::append(Turn& turn, std::size_t step, double from_s, double to_s,
                       const Vector3d& bias_rad_s) const {
  const double h_s = to_s - from_s;
  const Vector3d first = rate_in(step, from_s) - bias_rad_s;
  const Vector3d last = rate_in(step, to_s) - bias_rad_s;
  const Vector3d vector_rad = 0.5 * h_s * (first + last) + h_s * h_s / 12.0 * first.cross(last);
  const Matrix3d vector_per_bias_s =
      -h_s * Matrix3d::Identity() + h_s * h_s / 12.0 * cross_matrix(last - first);
  const PerGyroError vector_per_gyro_error = -h_s * measured_per_gyro_error(0.5 * (first + last));
  const Eigen::Quaterniond q = quaternion_by(vector_rad);
  const Matrix3d back = q.toRotationMatrix().transpose();
  const Matrix3d jacobian = right_jacobian(vector_rad);
  const double part = h_s / (samples_[step + 1].t_s - samples_[step].t_s);
  const Matrix3d noise_rad2 =
      h_s * steps_[step].noise_rad2_s * Matrix3d::Identity() + part * steps_[step].gap_rad2;
  turn.turn = (turn.turn * q).normalized();
  turn.per_bias_s = back * turn.per_bias_s + jacobian * vector_per_bias_s;
  turn.per_gyro_error = back * turn.per_gyro_error + jacobian * vector_per_gyro_error;
  turn.covariance_rad2 =
      back * turn.covariance_rad2 * back.transpose() + jacobian * noise_rad2 * jacobian.transpose();
}

std::vector<Turn> RateTrack::turns(std::span<const double> times_s,
                                   const Vector3d& bias_rad_s) const {
  std::vector<Turn> all;
  for (std::size_t i = 0; i + 1 < times_s.size(); ++i) {
    Turn& turn = all.emplace_back();
    double from_s = times_s[i];
    for (std::size_t step = step_at(from_s); from_s < times_s[i + 1]; ++step) {
      const bool is_last = step + 1 == steps_.size();
      const double to_s =
          is_last ? times_s[i + 1] : std::min(times_s[i + 1], samples_[step + 1].t_s);
      append(turn, step, from_s, to_s, bias_rad_s);
      from_s = to_s;
    }
  }
  return all;
}

}  // namespace spindrift
