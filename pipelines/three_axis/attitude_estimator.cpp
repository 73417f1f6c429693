#include "pipelines/three_axis/attitude_estimator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/observation/innovation_gate.h"
#include "pipelines/three_axis/error_culprit.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Random walk of the gyro bias as a fraction of its prior sigma, 1 % in a day: invisible within ten
// minutes, but enough for the filter to replace the bias of the first hour within a day.
constexpr double kBiasWalk_sqrt_s = 3e-5;
// Longest age at which a direction is still of use without a gyro.
constexpr double kAtOnce_s = 1.0;
// A sensor with one bad sample in ten stays clear of the share limit by chance, while one that is
// rejected entirely reaches it at its tenth sample. Rejected samples do not count as noise.
constexpr RecordRules kSampleRules{
    .recent = 20.0, .fewest_freedoms = 30.0, .most_freedoms = 900.0, .noise_from_share = 1.0};
constexpr double kMany = 0.4;
// The turn of a body whose gyro is wrong is unknown by as much as it turns in this time.
constexpr double kUnseenTurn_s = 2.0;
constexpr double kFewestSamples = 5.0;

/// Its trace is the mean square of the rotation angle between two random attitudes.
Matrix3d any_attitude_rad2() {
  return (std::numbers::pi * std::numbers::pi / 3.0 + 2.0) / 3.0 * Matrix3d::Identity();
}

/// Returns the projector on the axes about which a measurement determines the attitude, ICRF.
Matrix3d axes_of(const SeenDirection& seen) {
  const Vector3d along = seen.direction.ref.normalized();
  return Matrix3d::Identity() - along * along.transpose();
}
Matrix3d axes_of(const ObservedAttitude& /*attitude*/) { return Matrix3d::Identity(); }

bool is_unknown(const Mekf& filter) {
  return filter.attitude_covariance_rad2().trace() > kLargestSigma_rad * kLargestSigma_rad;
}

double square_of(const std::optional<double>& sigmas) { return sigmas ? *sigmas * *sigmas : 0.0; }

template <class Observed>
Observation observation_of(const Mekf& filter, const Observed& observed) {
  const auto [residual, nis] = filter.innovation(observed);
  Observation observation{
      .residual = residual, .nis = nis, .limit = innovation_gate(residual.freedom)};
  if (nis > observation.limit) {
    observation.rejected_by = Rejection::Innovation;
  }
  return observation;
}

/// Returns the field strength for a magnetometer sample, and 1 for the other sensors.
double length_of(const SeenDirection& seen) {
  return seen.kind == SampleKind::Magnetometer ? seen.direction.body.norm() : 1.0;
}
double length_of(const ObservedAttitude& /*attitude*/) { return 1.0; }

TaiTime time_of(const std::variant<StarFix, SeenDirection>& sample) {
  return std::visit([](const auto& is) { return is.t; }, sample);
}

}  // namespace

AttitudeEstimator::AttitudeEstimator(const ThreeAxisConfig& config)
    : config_{config},
      alignment_{config.alignment.topLeftCorner<kFilterErrors, kFilterErrors>()},
      gyro_{config.gyro.value_or(GyroSensor{})},
      gyro_unit_{config.gyro.value_or(GyroSensor{}).bias_sigma_rad_s},
      contradictions_{config},
      carried_{alignment_},
      ledger_{kSampleRules} {}

void AttitudeEstimator::push(const GyroSample& sample, Products& out) {
  if (const auto rejected = judge(sample)) {
    leave_out(*rejected, out);
    if (rejected->rejected_by == Rejection::Unit) {
      compare_refused(sample);
    }
    if (!waits_for_gyro(sample.t)) {
      give_way(sample.t, out);
      give_where_due(out);
    }
    return;
  }
  if (suspect_) {
    decide_suspect(sample, out);
  }
  if (const auto off = gyro_.deviation_from_line(sample); off && off->stands_out()) {
    suspect_ = sample;
  } else {
    take_in_gyro(sample, out);
  }
}

std::optional<RejectedSample> AttitudeEstimator::judge(const GyroSample& sample) {
  gyro_unit_.observe(sample);
  if (const auto factor = gyro_unit_.factor()) {
    return RejectedSample{.t = sample.t,
                          .kind = SampleKind::Gyro,
                          .rejected_by = Rejection::Unit,
                          .failed = FailedTest{.value = *factor, .limit = 1.0}};
  }
  return gyro_.judge(sample);
}

/// Compares rates in a wrong unit with the other sensors, although the filter has no use for them.
void AttitudeEstimator::compare_refused(const GyroSample& sample) {
  if (const auto before = std::exchange(refused_, sample)) {
    const double dt_s = elapsed_s(before->t, sample.t);
    contradictions_.turn(
        {.dt_s = dt_s, .from_rad_s = before->rate_body_rad_s, .to_rad_s = sample.rate_body_rad_s},
        std::pow(config_.gyro->noise_rad_s * dt_s, 2));
  }
}

void AttitudeEstimator::decide_suspect(const GyroSample& next, Products& out) {
  if (const GyroDeviation off = gyro_.deviation_from_both(*suspect_, next); off.stands_out()) {
    leave_out_suspect(off, out);
  } else {
    take_in_gyro(*std::exchange(suspect_, std::nullopt), out);
  }
}

void AttitudeEstimator::leave_out_suspect(const GyroDeviation& off, Products& out) {
  leave_out(outlier(*std::exchange(suspect_, std::nullopt), off), out);
}

void AttitudeEstimator::leave_out_suspect(Products& out) {
  if (suspect_) {
    leave_out_suspect(gyro_.deviation_from_line(*suspect_).value(), out);
  }
}

void AttitudeEstimator::take_in_gyro(const GyroSample& sample, Products& out) {
  const std::optional<GyroSample> before = gyro_.last();
  const bool gap = before && gyro_.is_gap(elapsed_s(before->t, sample.t));
  gyro_.accept(sample);
  contradictions_.note_scatter(sample.t, gyro_.noise_rad_s());
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
      // The first of several samples at the gyro sample's time propagates to it.
      const double share = time_of(waiting) == sample.t
                               ? 1.0
                               : elapsed_s(*t_, time_of(waiting)) / elapsed_s(*t_, sample.t);
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
    checks_ = 0.0;
  }
}

void AttitudeEstimator::push(const StarFix& fix, Products& out) {
  // A quaternion and its negative are one attitude.
  const double sign = fix.q_icrf_sensor.w() < 0.0 ? -1.0 : 1.0;
  if (is_frozen(fix.t, SampleKind::Star, sign * fix.q_icrf_sensor.coeffs(),
                0.5 * config_.star_tracker->noise_rad, out)) {
    return;
  }
  const auto factor = gyro_unit_.factor();
  gyro_unit_.observe(fix.t, observed_by(fix));
  contradictions_.note_unit(gyro_unit_.factor().has_value());
  if (gyro_unit_.factor() != factor) {
    leave_out_suspect(out);
    forget_gyro();
  }
  push_direct(fix, out);
}

void AttitudeEstimator::push(const SeenDirection& seen, Products& out) {
  const ObservedDirection& direction = seen.direction;
  if (!is_frozen(seen.t, seen.kind, direction.body, direction.sigma_rad * direction.body.norm(),
                 out)) {
    push_direct(seen, out);
  }
}

bool AttitudeEstimator::is_frozen(TaiTime t, SampleKind kind, const FrozenSamples::Values& values,
                                  double noise, Products& out) {
  FrozenSamples& frozen = frozen_.at(index_of(kind));
  const bool is_frozen = frozen.learn_and_test(values, noise) > 0;
  if (is_frozen) {
    leave_out({.t = t, .kind = kind, .rejected_by = Rejection::Frozen, .failed = frozen.failed()},
              out);
  }
  return is_frozen;
}

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

/// Propagates to `t` without waiting any longer for a gyro sample.
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

/// Propagates along a part of the interval between two gyro samples. The error of a sample turns
/// the body over half an interval on either side. In a gap the rate may also have changed unseen.
void AttitudeEstimator::follow(const GyroSample& to, const Interval& interval) {
  const double dt_s = elapsed_s(*t_, to.t);
  const double noise_rad_s = config_.gyro->noise_rad_s;
  double turn_rad2 = noise_rad_s * noise_rad_s * interval.length_s * dt_s;
  if (interval.is_gap) {
    turn_rad2 += (gyro_.wander_rad2_s3() * interval.length_s +
                  interval.change_rad_s * interval.change_rad_s) *
                 interval.length_s * dt_s / 12.0;
  }
  turn_rad2 = coasting_ ? coasted_rad2(interval.from, to.t) : turn_rad2;
  contradictions_.turn(span_to(to), turn_rad2);
  if (interval.is_gap || coasting_) {
    contradictions_.lose_gyro();
  }
  turn(to, turn_rad2);
}

/// Propagates with the last rate. Without any rate nothing is kept but the most recent directions.
void AttitudeEstimator::coast(TaiTime t, Products& out) {
  if (t_ == t) {
    return;
  }
  if (!t_) {
    begun_ = t;
  }
  if (!rate_rad_s_) {
    filter_.reset();
    rival_.reset();
    const double dt_s = t_ ? elapsed_s(*t_, t) : 0.0;
    // Sigma per axis of an unmeasured rate: a launcher releases a body with at most 10 deg/s.
    carried_.turn(t, Vector3d::Zero(), {.noise_rad2 = 0.0, .drift_rad = 5.0 * kRadPerDeg * dt_s},
                  kAtOnce_s);
    t_ = t;
    return;
  }
  contradictions_.lose_gyro();
  turn({.t = t, .rate_body_rad_s = *rate_rad_s_}, coasted_rad2(gyro_.last()->t, t));
  coasting_ = true;
  lose_where_unknown(out);
}

/// Returns the variance added by the turn from `t_` to `t`; the last gyro sample is at `measured`.
double AttitudeEstimator::coasted_rad2(TaiTime measured, TaiTime t) const {
  const double from_s = elapsed_s(measured, std::max(*t_, measured));
  const double to_s = elapsed_s(measured, t);
  const double noise_rad_s = config_.gyro->noise_rad_s;
  return noise_rad_s * noise_rad_s * (to_s * to_s - from_s * from_s) +
         gyro_.wander_rad2_s3() * (to_s * to_s * to_s - from_s * from_s * from_s) / 3.0;
}

RateSpan AttitudeEstimator::span_to(const GyroSample& to) const {
  return {.dt_s = elapsed_s(*t_, to.t), .from_rad_s = *rate_rad_s_, .to_rad_s = to.rate_body_rad_s};
}

void AttitudeEstimator::turn(const GyroSample& to, double turn_rad2) {
  const RateSpan span = span_to(to);
  t_ = to.t;
  rate_rad_s_ = to.rate_body_rad_s;
  if (span.dt_s == 0.0) {
    return;
  }
  const auto& found = contradictions_.found();
  gyro_was_wrong_ = gyro_was_wrong_ || (found && found->culprit == SampleSource::Gyro);
  if (gyro_was_wrong_) {
    turn_rad2 += span.to_rad_s.squaredNorm() * span.dt_s * kUnseenTurn_s;
  }
  const double walk_rad_s = kBiasWalk_sqrt_s * config_.gyro->bias_sigma_rad_s;
  const SpanErrors errors{.turn_rad2 = turn_rad2,
                          .bias_rad2_s2 = walk_rad_s * walk_rad_s * span.dt_s};
  if (rival_) {
    rival_->filter.propagate(span, errors);
    if (is_unknown(rival_->filter)) {
      rival_.reset();
    }
  }
  if (filter_) {
    filter_->propagate(span, errors);
  } else {
    carried_.turn(
        to.t, turned_rad(span, Vector3d::Zero()),
        {.noise_rad2 = turn_rad2, .drift_rad = config_.gyro->bias_sigma_rad_s * span.dt_s});
  }
}

void AttitudeEstimator::take_in(const Sample& sample, Products& out) {
  if (const auto* fix = std::get_if<StarFix>(&sample)) {
    take_in_star(*fix, out);
  } else {
    take_in_direction(std::get<SeenDirection>(sample), out);
  }
}

ObservedAttitude AttitudeEstimator::observed_by(const StarFix& fix) const {
  const StarTracker& tracker = *config_.star_tracker;
  return {.q_icrf_body = fix.q_icrf_sensor.normalized() * tracker.q_body_sensor.conjugate(),
          .sigma_rad = tracker.noise_rad};
}

void AttitudeEstimator::take_in_star(const StarFix& fix, Products& out) {
  const StarTracker& tracker = *config_.star_tracker;
  const ObservedAttitude observed = observed_by(fix);
  contradictions_.add(fix.t, observed);
  const SensitiveAttitude alone{
      {.q_ref_body = observed.q_icrf_body,
       .covariance_rad2 = tracker.noise_rad * tracker.noise_rad * Matrix3d::Identity()},
      -star_per_error(rate_body_rad_s())};
  if (!filter_) {
    note_accepted(SampleKind::Star, fix.t);
    has_fixes_ = true;
    begin(alone, out);
    return;
  }
  if (work_in(fix.t, SampleKind::Star, observed, out)) {
    has_fixes_ = true;
    return;
  }
  if (rival_ && rival_->overrules(*t_, is_confirmed())) {
    overrule(out);
  } else if (!rival_) {
    rival_ = RivalAttitude{.filter = filter_at(alone), .since = fix.t, .star_fixes = 1};
  }
  if (!rival_ || rival_->star_fixes < RivalAttitude::kEnough) {
    lose_where_rejected(out);
  }
}

void AttitudeEstimator::take_in_direction(const SeenDirection& seen, Products& out) {
  contradictions_.add(seen);
  if (filter_) {
    work_in(seen.t, seen.kind, seen, out);
    if (rival_ && rival_->is_proven()) {
      overrule(out);
    }
    lose_where_rejected(out);
    return;
  }
  tell_contradiction(seen.t, out);
  if (const double strength = square_of(seen.stronger); strength > innovation_gate(1)) {
    leave_out({.t = seen.t,
               .kind = seen.kind,
               .rejected_by = Rejection::Innovation,
               .failed = FailedTest{.value = strength, .limit = innovation_gate(1)}},
              out);
    return;
  }
  note_accepted(seen.kind, seen.t);
  carried_.add(seen, rate_body_rad_s());
  const SensorHealth& star = sensors_.at(index_of(SampleKind::Star));
  if (!rate_rad_s_ && star.last_seen && star.rejected_in_a_row == 0 &&
      elapsed_s(*star.last_seen, seen.t) <= kAtOnce_s) {
    return;  // The star fix gives the better attitude.
  }
  if (const auto attitude = carried_.attitude()) {
    has_fixes_ = false;
    begin(*attitude, out);
  }
}

/// Looks whether the innovations contradict what the mission file states. They do not forget, so
/// that where two sensors have contradicted each other these alone say whether they still do. They
/// know nothing of what was rejected, so that they name none where two attitudes stand.
void AttitudeEstimator::look_for_culprit(TaiTime t) {
  const bool is_unsettled =
      contradictions_.has_found() || began_anew_ || (rival_ && rival_->stands());
  by_errors_ = is_unsettled || !filter_->evidence().beyond()
                   ? std::nullopt
                   : contradiction_by_errors(filter_->evidence(), rate_body_rad_s(),
                                             by_errors_ ? by_errors_->since : t);
}

const std::optional<SensorContradiction>& AttitudeEstimator::contradiction() const {
  return contradictions_.found() ? contradictions_.found() : by_errors_;
}

/// Tells of a contradiction, and of its end, where no estimate does.
void AttitudeEstimator::tell_contradiction(TaiTime t, Products& out) {
  if (contradictions_.has_found()) {
    out.emplace_back(SensorsCompared{.t = t, .contradiction = contradictions_.found()});
  }
}

/// @return True if the filter accepts the sample.
template <class Observed>
bool AttitudeEstimator::work_in(TaiTime t, SampleKind kind, const Observed& observed,
                                Products& out) {
  Observation said = observation_of(*filter_, observed);
  said.t = t;
  said.source = source_of(kind);
  if (rival_ && !rival_->hear(observed, !observation_of(rival_->filter, observed).rejected_by,
                              !said.rejected_by)) {
    rival_.reset();
  }
  contradicted_rad_ =
      said.rejected_by ? std::max(contradicted_rad_, said.residual.value.norm()) : 0.0;
  const double length = length_of(observed);
  said.residual.value *= length;
  said.residual.sigma *= length;
  out.emplace_back(SampleObservation{.estimator = AttitudeSource::Mekf, .said = said});
  rejected_.at(index_of(kind)) = said.rejected_by ? std::optional{t} : std::nullopt;
  if (said.rejected_by) {
    leave_out({.t = t,
               .kind = kind,
               .rejected_by = *said.rejected_by,
               .failed = FailedTest{.value = said.nis, .limit = said.limit}},
              out);
    if (!is_out(kind)) {
      ledger_.add({&said, 1});
      ++rejected_in_a_row_;
    }
    return false;
  }
  // What errors of the mission file have explained before is no noise. A sample that no more than
  // could be explained by them may be spurious, so that its size is arbitrary.
  said.nis = std::min(filter_->update(observed), said.limit);
  look_for_culprit(t);
  ledger_.add({&said, 1});
  since_given_.squared += said.nis;
  since_given_.freedom += said.residual.freedom;
  note_accepted(kind, t);
  rejected_in_a_row_ = 0;
  if (checks_ < kEnoughToCheck) {
    checked_ += axes_of(observed);
    checks_ =
        Eigen::SelfAdjointEigenSolver<Matrix3d>{checked_, Eigen::EigenvaluesOnly}.eigenvalues()[0];
  }
  if (checks_ >= kEnoughToCheck) {
    unchecked_gaps_ = 0;
    longest_gap_s_ = 0.0;
  }
  return true;
}

/// Keeps the attitude that was in force as the new rival, unless nothing supports it any longer.
void AttitudeEstimator::overrule(Products& out) {
  const RivalAttitude winner = *std::exchange(rival_, std::nullopt);
  const bool is_proven = winner.is_proven();
  const bool is_back = winner.was_in_force && !is_proven;
  if (is_proven ? winner.was_in_force : !is_back && is_confirmed()) {
    rival_ = RivalAttitude{.filter = *filter_,
                           .since = *t_,
                           .was_in_force = !is_proven,
                           .has_fixes = has_fixes_,
                           .star_fixes = is_proven ? RivalAttitude::kEnough : 0,
                           .against = -winner.against};
  }
  filter_ = winner.filter;
  has_fixes_ = winner.has_fixes;
  began_anew_ = true;
  start(out);
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

Mekf AttitudeEstimator::filter_at(const SensitiveAttitude& attitude) const {
  return {attitude, config_.gyro ? config_.gyro->bias_sigma_rad_s : 0.0, alignment_};
}

/// Drops the rival, which is the lost attitude, if the new attitude agrees with it.
void AttitudeEstimator::begin(const SensitiveAttitude& attitude, Products& out) {
  filter_ = filter_at(attitude);
  if (rival_ && rival_->filter.innovation(*filter_).nis <= innovation_gate(3)) {
    rival_.reset();
  }
  start(out);
}

void AttitudeEstimator::start(Products& out) {
  carried_.forget();
  ledger_ = Ledger{kSampleRules};
  since_given_ = {};
  rejected_.fill(std::nullopt);
  rejected_in_a_row_ = 0;
  checked_.setZero();
  checks_ = 0.0;
  unchecked_gaps_ = 0;
  longest_gap_s_ = 0.0;
  since_ = t_;
  give(out);
}

void AttitudeEstimator::lose_where_unknown(Products& out) {
  if (filter_ && is_unknown(*filter_)) {
    lose(out);
  }
}

void AttitudeEstimator::lose_where_rejected(Products& out) {
  if (rejected_in_a_row_ >= kLostInARow && !is_held()) {
    lose(out);
  }
}

/// Keeps a confirmed attitude as the rival, so that star fixes that contradict it are noticed.
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
                                    .noise_sigma_rad = std::sqrt(any_attitude_rad2().trace()),
                                    .assessment = std::move(assessment),
                                    .contradiction = contradiction()});
  if (!rival_ || !rival_->was_in_force) {
    rival_.reset();
    if (is_confirmed()) {
      rival_ = RivalAttitude{
          .filter = *filter_, .since = *t_, .was_in_force = true, .has_fixes = has_fixes_};
    }
  }
  filter_.reset();
  began_anew_ = true;
  lost_by_rad_ = std::clamp(contradicted_rad_, lost_by_rad_.value_or(0.0), std::numbers::pi);
}

void AttitudeEstimator::give_where_due(Products& out) {
  // At most ten estimates per second of telemetry time, allowing for jitter of the sample times.
  if (filter_ && (!given_ || elapsed_s(*given_, *t_) >= 0.095)) {
    give(out);
  }
}

void AttitudeEstimator::give(Products& out) {
  given_ = t_;
  if (is_confirmed_anew()) {
    lost_by_rad_.reset();
  }
  const double lost_by_rad = lost_by_rad_.value_or(0.0);
  const Matrix3d own_rad2 = filter_->attitude_covariance_rad2(excess_noise());
  const Matrix3d covariance_rad2 =
      own_rad2 + lost_by_rad * lost_by_rad / 3.0 * Matrix3d::Identity();
  AttitudeEstimate estimate{
      .t = *t_,
      .q_icrf_body = filter_->q_icrf_body(),
      .rate_body_rad_s = std::nullopt,
      .covariance_rad2 = covariance_rad2,
      .noise_sigma_rad = std::sqrt(excess_noise() * filter_->attitude_noise_rad2().trace()),
      .assessment = assess(std::sqrt(own_rad2.trace())),
      .innovations = std::exchange(since_given_, {}),
      .contradiction = contradiction()};
  if (rate_rad_s_ && !gyro_is_out()) {
    estimate.rate_body_rad_s = *rate_rad_s_ - filter_->bias_rad_s();
  }
  // Estimates carry the bias at most once a second, because it drifts over hours.
  if (gyro_.last() && (!bias_given_ || elapsed_s(*bias_given_, *t_) >= 1.0)) {
    bias_given_ = t_;
    estimate.gyro_bias = {.rad_s = filter_->bias_rad_s(),
                          .covariance_rad2_s2 = filter_->covariance().bottomRightCorner<3, 3>()};
  }
  out.emplace_back(std::move(estimate));
}

double AttitudeEstimator::excess_noise() const {
  double most = 1.0;
  for (std::size_t i = 0; i < kSampleKinds; ++i) {
    most = std::max(most, record_of(static_cast<SampleKind>(i)).excess_noise());
  }
  return most;
}

/// Discards the gyro state, which is in the former unit, when the detected unit changes.
void AttitudeEstimator::forget_gyro() {
  gyro_ = GyroWatch{*config_.gyro};
  rate_rad_s_.reset();
  coasting_ = false;
}

Vector3d AttitudeEstimator::rate_body_rad_s() const {
  return rate_rad_s_.value_or(Vector3d::Zero());
}

bool AttitudeEstimator::gyro_is_out() const {
  return gyro_.last() ? elapsed_s(gyro_.last()->t, *t_) > kGyroWait_s
                      : gyro_.out_because().has_value();
}

/// Returns whether samples besides the initial fix support the attitude and the gyro is not out.
bool AttitudeEstimator::is_confirmed() const { return checks_ > 0.5 && !gyro_is_out(); }

/// Returns whether samples of two kinds support the attitude, or samples of one for long.
bool AttitudeEstimator::is_confirmed_anew() const {
  const auto supports = [this](SampleKind kind) {
    const ObservationRecord& record = record_of(kind);
    return record.heard() * (1.0 - record.share_left_out()) >= RivalAttitude::kEnough;
  };
  const int kinds = (supports(SampleKind::Star) ? 1 : 0) + (supports(SampleKind::Sun) ? 1 : 0) +
                    (supports(SampleKind::Magnetometer) ? 1 : 0);
  return kinds >= 2 || elapsed_s(*since_, *t_) >= kConfirmedAnew_s;
}

bool AttitudeEstimator::is_held() const {
  return std::any_of(sensors_.begin() + index_of(SampleKind::Star), sensors_.end(),
                     [this](const SensorHealth& sensor) {
                       return sensor.rejected_in_a_row == 0 && sensor.last_seen &&
                              elapsed_s(*sensor.last_seen, *t_) < kHeld_s;
                     });
}

/// Returns whether the attitude has rejected the last sample of the sensor: one of the two is
/// wrong.
bool AttitudeEstimator::is_in_question(SampleKind kind) const {
  const auto& rejected = rejected_.at(index_of(kind));
  return rejected && elapsed_s(*rejected, *t_) < kHeld_s;
}

/// Returns whether the sensor is known to be wrong. For a star tracker, other sensors must confirm
/// an attitude that its own earlier fixes supported; else it would be one sensor against another.
bool AttitudeEstimator::is_out(SampleKind kind) const {
  // A shorter run of repeats occurs when a sensor is read more often than it measures.
  return frozen_.at(index_of(kind)).repeats() >= 5 ||
         (kind == SampleKind::Star && has_fixes_ && rival_ && rival_->stands() &&
          rival_->is_refuted());
}

/// Returns whether nothing can check an attitude, since there has been no rate from the start.
bool AttitudeEstimator::never_had_gyro() const {
  return !gyro_.last() && !gyro_is_out() && elapsed_s(begun_, *t_) > kGyroWait_s;
}

Reason AttitudeEstimator::why_no_gyro() const {
  const auto why = gyro_.out_because();
  const std::string_view silent = config_.gyro ? "silent" : "undeclared";
  const TaiTime since = why ? gyro_.out_since() : begun_;
  return {ReasonCode::NoGyro,
          {{"why", std::string{why ? name_of(*why) : silent}},
           {"since_tai_ns", tai_ns(gyro_.last() ? gyro_.last()->t : since)}}};
}

Assessment AttitudeEstimator::assess(double sigma_rad) const {
  Assessment assessment{.quality = Quality::Ok};
  std::vector<Reason>& reasons = assessment.reasons;
  std::vector<Reason> known;  // Reasons that cast no doubt on the attitude.
  if (const auto factor = gyro_unit_.factor()) {
    reasons.push_back({ReasonCode::GyroUnit, {{"factor", *factor}}});
  }
  if (gyro_is_out()) {
    reasons.push_back(why_no_gyro());
  }
  if (unchecked_gaps_ > 0) {
    reasons.push_back(
        {ReasonCode::GyroGaps, {{"count", unchecked_gaps_}, {"longest_s", longest_gap_s_}}});
  }
  if (never_had_gyro()) {
    known.push_back(why_no_gyro());
  }
  bool is_checked = checks_ >= kEnoughToCheck && !lost_by_rad_;
  for (std::size_t i = 0; i < kSampleKinds; ++i) {
    const auto kind = static_cast<SampleKind>(i);
    const ObservationRecord& record = record_of(kind);
    const std::string sensor{name_of(kind)};
    if (is_out(kind)) {
      known.push_back({ReasonCode::SensorGated, {{"sensor", sensor}}});
    } else if (record.heard() >= kFewestSamples && record.share_left_out() > kMany) {
      reasons.push_back({ReasonCode::SensorGated, {{"sensor", sensor}}});
    } else if (record.heard() > 0.0 && (record.share_left_out() == 1.0 || is_in_question(kind))) {
      is_checked = false;
    }
    if (const double excess = record.excess_noise(); excess > 1.0) {
      reasons.push_back(
          {ReasonCode::SensorNoise, {{"sensor", sensor}, {"factor", std::sqrt(excess)}}});
    }
  }
  if (rival_ && rival_->stands() && !rival_->is_refuted() && (has_fixes_ || rival_->has_fixes)) {
    reasons.push_back({ReasonCode::StarFixesContradict, {}});
  }
  if (const auto beyond = filter_->evidence().beyond()) {
    reasons.push_back({ReasonCode::AlignmentOff,
                       {{"key", "three_axis.alignment." + std::string{beyond->key}},
                        {"sigmas", beyond->sigmas}}});
  }
  if (const auto& found = contradiction();
      found && !(found->culprit && is_out(kind_of(*found->culprit)))) {
    reasons.push_back(reason_of(*found));
  }
  if (sigma_rad > kOpen_rad) {
    reasons.push_back({ReasonCode::AttitudeOpen, {{"deg", degrees(sigma_rad)}}});
  }
  if (!reasons.empty()) {
    assessment.quality = Quality::Doubtful;
  } else if (!is_checked) {
    assessment.quality = Quality::Converging;
  }
  reasons.insert(reasons.end(), known.begin(), known.end());
  if (began_anew_) {
    reasons.push_back({ReasonCode::Since, {{"since_tai_ns", tai_ns(*since_)}}});
  }
  return assessment;
}

}  // namespace spindrift
