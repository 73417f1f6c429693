#include "pipelines/three_axis/attitude_estimator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Of the bias's prior, along one square root of a second: 1 % of it in a day. Ten minutes do not
// show it, and a day does not hold the bias of its first hour for the present one.
constexpr double kBiasWalk_sqrt_s = 3e-5;
// At most ten estimates a second of telemetry time, however the times of samples jitter.
constexpr double kShortest_s = 0.095;

/// Its trace is the mean square of the angle between two attitudes of which nothing is known.
Matrix3d any_attitude_rad2() {
  return (std::numbers::pi * std::numbers::pi / 3.0 + 2.0) / 3.0 * Matrix3d::Identity();
}

int freedom_of(const ObservedDirection& /*direction*/) { return 2; }
int freedom_of(const ObservedAttitude& /*attitude*/) { return 3; }

/// About which axes a measurement speaks, ICRF.
Matrix3d axes_of(const ObservedDirection& direction) {
  const Vector3d along = direction.ref.normalized();
  return Matrix3d::Identity() - along * along.transpose();
}
Matrix3d axes_of(const ObservedAttitude& /*attitude*/) { return Matrix3d::Identity(); }

double square_of(const std::optional<double>& sigmas) { return sigmas ? *sigmas * *sigmas : 0.0; }

TaiTime time_of(const std::variant<StarFix, SeenDirection>& sample) {
  return std::visit([](const auto& is) { return is.t; }, sample);
}

}  // namespace

AttitudeEstimator::AttitudeEstimator(const ThreeAxisConfig& config)
    : config_{config}, gyro_{config.gyro.value_or(GyroSensor{})} {}

void AttitudeEstimator::push(const GyroSample& sample, Products& out) {
  if (const auto rejection = gyro_.judge(sample)) {
    leave_out({.t = sample.t, .kind = SampleKind::Gyro, .rejected_by = *rejection}, out);
    if (!waits_for_gyro(sample.t)) {
      give_way(sample.t, out);
      give_where_due(out);
    }
    return;
  }
  if (suspect_) {
    decide_suspect(sample, out);
  }
  if (gyro_.is_suspect(sample)) {
    suspect_ = sample;
  } else {
    take_in_gyro(sample, out);
  }
}

void AttitudeEstimator::decide_suspect(const GyroSample& next, Products& out) {
  if (gyro_.is_outlier(*suspect_, next)) {
    leave_out_suspect(out);
  } else {
    take_in_gyro(*std::exchange(suspect_, std::nullopt), out);
  }
}

void AttitudeEstimator::leave_out_suspect(Products& out) {
  if (suspect_) {
    leave_out({.t = std::exchange(suspect_, std::nullopt)->t,
               .kind = SampleKind::Gyro,
               .rejected_by = SampleRejection::Outlier},
              out);
  }
}

void AttitudeEstimator::take_in_gyro(const GyroSample& sample, Products& out) {
  const std::optional<GyroSample> before = gyro_.last();
  const bool gap = before && gyro_.is_gap(elapsed_s(before->t, sample.t));
  gyro_.accept(sample);
  note_accepted(SampleKind::Gyro, sample.t);
  if (before) {
    const double length_s = elapsed_s(before->t, sample.t);
    const Interval interval{
        .from = before->t,
        .length_s = length_s,
        .is_gap = gap,
        .change_rad_s = (sample.rate_body_rad_s - before->rate_body_rad_s).norm()};
    if (gap && length_s > kGyroWait_s) {
      note_gap(length_s);
    }
    while (!waiting_.empty() && time_of(waiting_.front()) <= sample.t) {
      const Sample waiting = std::move(waiting_.front());
      waiting_.pop_front();
      const double share = elapsed_s(*t_, time_of(waiting)) / elapsed_s(*t_, sample.t);
      follow({.t = time_of(waiting),
              .rate_body_rad_s = *rate_rad_s_ + share * (sample.rate_body_rad_s - *rate_rad_s_)},
             interval);
      take_in(waiting, out);
    }
    follow(sample, interval);
    lose_where_unknown(out);
  } else {
    coast(sample.t, out);
    rate_rad_s_ = sample.rate_body_rad_s;
  }
  coasting_ = false;
  give_where_due(out);
}

void AttitudeEstimator::note_gap(double length_s) {
  if (filter_) {
    ++unchecked_gaps_;
    longest_gap_s_ = std::max(longest_gap_s_, length_s);
    checked_.setZero();
    is_checked_ = false;
  }
}

void AttitudeEstimator::push(const StarFix& fix, Products& out) { push_direct(fix, out); }
void AttitudeEstimator::push(const SeenDirection& seen, Products& out) { push_direct(seen, out); }

void AttitudeEstimator::push_direct(const Sample& sample, Products& out) {
  const TaiTime t = time_of(sample);
  if (waits_for_gyro(t)) {
    waiting_.push_back(sample);
    return;
  }
  give_way(t, out);
  take_in(sample, out);
  if (gyro_is_out() || !rate_rad_s_) {
    give_where_due(out);
  }
}

bool AttitudeEstimator::waits_for_gyro(TaiTime t) const {
  return gyro_.last() && t > *t_ && elapsed_s(gyro_.last()->t, t) <= kGyroWait_s;
}

void AttitudeEstimator::take_in_waiting(Products& out) {
  for (const Sample& waiting : std::exchange(waiting_, {})) {
    coast(time_of(waiting), out);
    take_in(waiting, out);
  }
}

/// No gyro sample is waited for any longer.
void AttitudeEstimator::give_way(TaiTime t, Products& out) {
  leave_out_suspect(out);
  take_in_waiting(out);
  coast(t, out);
}

void AttitudeEstimator::settle(Products& out) {
  leave_out_suspect(out);
  take_in_waiting(out);
  if (filter_ && given_ != t_) {
    give(out);
  }
}

/// Along a part of the interval between two gyro samples. The error of each sample turns the body
/// by half an interval to either side; where samples are missing, the rate may have changed unseen.
void AttitudeEstimator::follow(const GyroSample& to, const Interval& interval) {
  const double dt_s = elapsed_s(*t_, to.t);
  const double noise_rad_s = config_.gyro->noise_rad_s;
  double turn_rad2 = noise_rad_s * noise_rad_s * interval.length_s * dt_s;
  if (interval.is_gap) {
    turn_rad2 += (gyro_.wander_rad2_s3() * interval.length_s +
                  interval.change_rad_s * interval.change_rad_s) *
                 interval.length_s * dt_s / 12.0;
  }
  turn(to, coasting_ ? coasted_rad2(interval.from, to.t) : turn_rad2);
}

/// The last rate is held. Without any, nothing that was known holds.
void AttitudeEstimator::coast(TaiTime t, Products& out) {
  if (t_ == t) {
    return;
  }
  if (!rate_rad_s_) {
    filter_.reset();
    carried_.forget();
    rejected_stars_.forget();
    t_ = t;
    return;
  }
  turn({.t = t, .rate_body_rad_s = *rate_rad_s_}, coasted_rad2(gyro_.last()->t, t));
  coasting_ = true;
  lose_where_unknown(out);
}

/// Variance that the turn from here to `t` adds where the gyro measured last at `measured`.
double AttitudeEstimator::coasted_rad2(TaiTime measured, TaiTime t) const {
  const double from_s = elapsed_s(measured, std::max(*t_, measured));
  const double to_s = elapsed_s(measured, t);
  const double noise_rad_s = config_.gyro->noise_rad_s;
  return noise_rad_s * noise_rad_s * (to_s * to_s - from_s * from_s) +
         gyro_.wander_rad2_s3() * (to_s * to_s * to_s - from_s * from_s * from_s) / 3.0;
}

void AttitudeEstimator::turn(const GyroSample& to, double turn_rad2) {
  const RateSpan span{
      .dt_s = elapsed_s(*t_, to.t), .from_rad_s = *rate_rad_s_, .to_rad_s = to.rate_body_rad_s};
  t_ = to.t;
  rate_rad_s_ = to.rate_body_rad_s;
  if (span.dt_s == 0.0) {
    return;
  }
  const CarryError error{.noise_rad2 = turn_rad2,
                         .drift_rad = config_.gyro->bias_sigma_rad_s * span.dt_s};
  if (!filter_) {
    carried_.turn(to.t, turned_rad(span, Vector3d::Zero()), error);
    return;
  }
  rejected_stars_.turn(turned_rad(span, filter_->bias_rad_s()), error);
  const double walk_rad_s = kBiasWalk_sqrt_s * config_.gyro->bias_sigma_rad_s;
  filter_->propagate(span,
                     {.turn_rad2 = turn_rad2, .bias_rad2_s2 = walk_rad_s * walk_rad_s * span.dt_s});
}

void AttitudeEstimator::take_in(const Sample& sample, Products& out) {
  if (const auto* fix = std::get_if<StarFix>(&sample)) {
    take_in_star(*fix, out);
  } else {
    take_in_direction(std::get<SeenDirection>(sample), out);
  }
}

void AttitudeEstimator::take_in_star(const StarFix& fix, Products& out) {
  const StarTracker& tracker = *config_.star_tracker;
  const ObservedAttitude observed{
      .q_icrf_body = fix.q_icrf_sensor.normalized() * tracker.q_body_sensor.conjugate(),
      .sigma_rad = tracker.noise_rad};
  const UncertainAttitude alone{
      .q_ref_body = observed.q_icrf_body,
      .covariance_rad2 = tracker.noise_rad * tracker.noise_rad * Matrix3d::Identity()};
  if (!filter_) {
    note_accepted(SampleKind::Star, fix.t);
    begin(alone, out);
  } else if (work_in(fix.t, SampleKind::Star, observed, std::nullopt, out)) {
    rejected_stars_.forget();
  } else if (filter_ && rejected_stars_.note(observed)) {
    began_anew_ = true;
    begin(alone, out);
  }
}

void AttitudeEstimator::take_in_direction(const SeenDirection& seen, Products& out) {
  if (filter_) {
    work_in(seen.t, seen.kind, seen.direction, seen.stronger, out);
    return;
  }
  if (const double strength = square_of(seen.stronger); strength > innovation_gate(1)) {
    leave_out({.t = seen.t,
               .kind = seen.kind,
               .rejected_by = SampleRejection::Innovation,
               .squared_innovation = strength},
              out);
    return;
  }
  note_accepted(seen.kind, seen.t);
  carried_.add(seen.kind, seen.t, seen.direction);
  if (const auto attitude = carried_.attitude()) {
    begin(*attitude, out);
  }
}

/// @return Whether the filter accepts it.
template <class Observed>
bool AttitudeEstimator::work_in(TaiTime t, SampleKind kind, const Observed& observed,
                                const std::optional<double>& stronger, Products& out) {
  const int freedom = freedom_of(observed) + (stronger ? 1 : 0);
  const double squared_innovation = filter_->squared_innovation(observed) + square_of(stronger);
  InnovationRecord& innovations = innovations_.at(index_of(kind));
  if (squared_innovation > innovation_gate(freedom)) {
    innovations.rejected();
    leave_out({.t = t,
               .kind = kind,
               .rejected_by = SampleRejection::Innovation,
               .squared_innovation = squared_innovation},
              out);
    if (++rejected_in_a_row_ >= kLostInARow) {
      lose(out);
    }
    return false;
  }
  filter_->update(observed);
  innovations.accepted(squared_innovation, freedom);
  since_given_.squared += squared_innovation;
  since_given_.freedom += freedom;
  note_accepted(kind, t);
  rejected_in_a_row_ = 0;
  if (!is_checked_) {
    checked_ += axes_of(observed);
    is_checked_ = Eigen::SelfAdjointEigenSolver<Matrix3d>{checked_, Eigen::EigenvaluesOnly}
                      .eigenvalues()[0] >= kEnoughToCheck;
  }
  if (is_checked_) {
    unchecked_gaps_ = 0;
    longest_gap_s_ = 0.0;
  }
  return true;
}

void AttitudeEstimator::note_accepted(SampleKind kind, TaiTime t) {
  SensorHealth& health = sensors_.at(index_of(kind));
  ++health.accepted;
  health.rejected_in_a_row = 0;
  health.last_seen = std::max(health.last_seen.value_or(t), t);
}

void AttitudeEstimator::leave_out(const RejectedSample& rejected, Products& out) {
  SensorHealth& health = sensors_.at(index_of(rejected.kind));
  ++health.rejected;
  ++health.rejected_in_a_row;
  health.last_seen = std::max(health.last_seen.value_or(rejected.t), rejected.t);
  out.emplace_back(rejected);
}

void AttitudeEstimator::begin(const UncertainAttitude& attitude, Products& out) {
  filter_.emplace(attitude, config_.gyro ? config_.gyro->bias_sigma_rad_s : 0.0);
  carried_.forget();
  rejected_stars_.forget();
  innovations_ = {};
  since_given_ = {};
  rejected_in_a_row_ = 0;
  checked_.setZero();
  is_checked_ = false;
  unchecked_gaps_ = 0;
  longest_gap_s_ = 0.0;
  since_ = t_;
  give(out);
}

void AttitudeEstimator::lose_where_unknown(Products& out) {
  if (filter_ &&
      filter_->attitude_covariance_rad2().trace() > kLargestSigma_rad * kLargestSigma_rad) {
    lose(out);
  }
}

void AttitudeEstimator::lose(Products& out) {
  Assessment assessment{.quality = Quality::Lost, .reasons = {Reason{ReasonCode::AwaitingFix, {}}}};
  if (gyro_is_out()) {
    assessment.reasons.push_back(why_no_gyro());
  }
  given_ = t_;
  out.emplace_back(AttitudeEstimate{.t = *t_,
                                    .q_icrf_body = filter_->q_icrf_body(),
                                    .rate_body_rad_s = std::nullopt,
                                    .covariance_rad2 = any_attitude_rad2(),
                                    .assessment = std::move(assessment)});
  filter_.reset();
  began_anew_ = true;
}

void AttitudeEstimator::give_where_due(Products& out) {
  if (filter_ && (!given_ || elapsed_s(*given_, *t_) >= kShortest_s)) {
    give(out);
  }
}

void AttitudeEstimator::give(Products& out) {
  given_ = t_;
  AttitudeEstimate estimate{.t = *t_,
                            .q_icrf_body = filter_->q_icrf_body(),
                            .rate_body_rad_s = std::nullopt,
                            .covariance_rad2 = excess_noise() * filter_->attitude_covariance_rad2(),
                            .assessment = assess(),
                            .innovations = std::exchange(since_given_, {})};
  if (rate_rad_s_ && !gyro_is_out()) {
    estimate.rate_body_rad_s = *rate_rad_s_ - filter_->bias_rad_s();
  }
  out.emplace_back(std::move(estimate));
}

double AttitudeEstimator::excess_noise() const {
  double most = 1.0;
  for (const InnovationRecord& innovations : innovations_) {
    most = std::max(most, innovations.excess_noise());
  }
  return most;
}

bool AttitudeEstimator::gyro_is_out() const {
  return gyro_.last() && elapsed_s(gyro_.last()->t, *t_) > kGyroWait_s;
}

Reason AttitudeEstimator::why_no_gyro() const {
  const auto why = gyro_.out_because();
  return {ReasonCode::NoGyro,
          {{"why", std::string{why ? name_of(*why) : "silent"}},
           {"since_tai_ns", tai_ns(gyro_.last()->t)}}};
}

Assessment AttitudeEstimator::assess() const {
  Assessment assessment{.quality = is_checked_ ? Quality::Ok : Quality::Converging};
  std::vector<Reason>& reasons = assessment.reasons;
  if (gyro_is_out()) {
    reasons.push_back(why_no_gyro());
  }
  if (unchecked_gaps_ > 0) {
    reasons.push_back(
        {ReasonCode::GyroGaps, {{"count", unchecked_gaps_}, {"longest_s", longest_gap_s_}}});
  }
  for (std::size_t kind = 0; kind < kSampleKinds; ++kind) {
    const InnovationRecord& innovations = innovations_.at(kind);
    const std::string sensor{name_of(static_cast<SampleKind>(kind))};
    if (innovations.many_rejected()) {
      reasons.push_back({ReasonCode::SensorGated, {{"sensor", sensor}}});
    }
    if (const double excess = innovations.excess_noise(); excess > 1.0) {
      reasons.push_back(
          {ReasonCode::SensorNoise, {{"sensor", sensor}, {"factor", std::sqrt(excess)}}});
    }
  }
  const double sigma_rad = std::sqrt(excess_noise() * filter_->attitude_covariance_rad2().trace());
  if (sigma_rad > kOpen_rad) {
    reasons.push_back({ReasonCode::AttitudeOpen, {{"deg", degrees(sigma_rad)}}});
  }
  if (!reasons.empty()) {
    assessment.quality = Quality::Doubtful;
  }
  if (began_anew_) {
    reasons.push_back({ReasonCode::Since, {{"since_tai_ns", tai_ns(*since_)}}});
  }
  return assessment;
}

}  // namespace spindrift
