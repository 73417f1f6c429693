#include "pipelines/supervision/spin_conditions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// Noise may put a single answer off; the condition must hold over several.
constexpr Holding kSeveralAnswers{.raise_s = 10.0, .clear_s = 10.0};
constexpr double kApartAtMost_s = 60.0;  // Longest time between compared answers.

constexpr Holding as_long_again(double held_s) { return {.raise_s = held_s, .clear_s = held_s}; }

double sigma_deg_of(const SpinEstimate& estimate) {
  return std::sqrt(estimate.covariance_rad2.trace()) * kDegPerRad;
}

double degrees_between(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return angle_between_rad(one, other) * kDegPerRad;
}

}  // namespace

SpinConditions::SpinConditions(const SpinConfig& config, Orbit orbit, const AlertLimits& limits,
                               std::optional<SpinTarget> target)
    : limits_{limits},
      target_{std::move(target)},
      channels_{config, std::move(orbit), limits.silent_revolutions},
      irrational_{limits.period.revolutions, 1},
      left_out_{limits.rejection.revolutions, kPulseChannels},
      interference_{AlertCode::SpinInterference, "s", {.raise_s = 0.0, .clear_s = 60.0}},
      period_{AlertCode::SpinPeriod, "%"},
      rejection_{AlertCode::SpinRejection, "%"},
      ambiguous_{AlertCode::SpinAmbiguous, "s", as_long_again(limits.ambiguous_s)},
      doubtful_{AlertCode::SpinDoubtful, "s", as_long_again(limits.doubtful_s)},
      sigma_{AlertCode::SpinSigma, "deg"},
      disagree_{AlertCode::SpinDisagree, "sigma", kSeveralAnswers},
      off_target_{AlertCode::SpinOffTarget, "deg", kSeveralAnswers},
      nutation_{AlertCode::SpinNutation, "deg"},
      rate_{AlertCode::SpinRate, "rpm", kSeveralAnswers},
      lost_{AlertCode::AttitudeLost, "s"} {}

void SpinConditions::set_limits(const AlertLimits& limits) {
  if (limits.period.revolutions != limits_.period.revolutions) {
    irrational_ = TurnShare{limits.period.revolutions, 1};
  }
  if (limits.rejection.revolutions != limits_.rejection.revolutions) {
    left_out_ = TurnShare{limits.rejection.revolutions, kPulseChannels};
  }
  channels_.set_silent_revolutions(limits.silent_revolutions);
  ambiguous_.hold(as_long_again(limits.ambiguous_s));
  doubtful_.hold(as_long_again(limits.doubtful_s));
  limits_ = limits;
}

void SpinConditions::set_target(TaiTime t, const Eigen::Vector3d& axis_icrf) {
  targets_.emplace(t, axis_icrf);
}

ConditionChanges SpinConditions::evaluate(const PulseUse& use) {
  std::optional<AxisSeen> axis;
  if (const auto& answer = sequential_ ? sequential_ : mean_;
      answer && is_unopposed(answer->assessment.quality)) {
    axis = AxisSeen{.axis_icrf = answer->axis_icrf,
                    .sigma_rad = std::sqrt(answer->covariance_rad2.trace())};
  }
  // A copy is not a further edge of its channel.
  const bool is_copy = use.rejected_by == Rejection::Copy;
  ConditionChanges changes = is_copy ? ConditionChanges{} : channels_.evaluate(use.pulse, axis);
  add(interference_.update(use.pulse.t, use.rejected_by == Rejection::Interference), changes);
  if (use.revolution || is_copy || use.rejected_by == Rejection::Unassociated) {
    if (const auto percent = left_out_.count(use.revolution, use.rejected_by.has_value())) {
      add(rejection_.update(use.pulse.t, {.value = *percent, .limit = limits_.rejection.percent}),
          changes);
    }
  }
  return changes;
}

ConditionChanges SpinConditions::evaluate(const RevolutionProduct& revolution) {
  t_sun1_.insert_or_assign(revolution.revolution, revolution.t_sun1);
  return {};
}

ConditionChanges SpinConditions::evaluate(const SpinMeasurement& measurement) {
  ConditionChanges changes;
  const auto t = t_sun1_.find(measurement.revolution);
  if (measurement.quantity != SpinQuantity::Period || t == t_sun1_.end()) {
    return changes;
  }
  if (const auto percent =
          irrational_.count(measurement.revolution, measurement.rejected_by.has_value())) {
    add(period_.update(t->second, {.value = *percent, .limit = limits_.period.percent}), changes);
  }
  t_sun1_.erase(t_sun1_.begin(), t);
  return changes;
}

ConditionChanges SpinConditions::evaluate(const SpinEstimate& estimate) {
  ConditionChanges changes;
  if (estimate.estimator == SpinEstimator::Batch) {
    return changes;
  }
  const auto later = manoeuvres_.upper_bound(estimate.t);
  if (later != manoeuvres_.begin()) {
    first_.reset();
    manoeuvres_.erase(manoeuvres_.begin(), later);
  }
  first_ = first_.value_or(estimate.t);
  const bool is_sequential = estimate.estimator == SpinEstimator::Sequential;
  (is_sequential ? sequential_ : mean_) = estimate;
  if (is_sequential || !sequential_) {
    evaluate_in_force(estimate, changes);
  }
  evaluate_disagreement(changes);
  return changes;
}

void SpinConditions::evaluate_in_force(const SpinEstimate& estimate, ConditionChanges& changes) {
  const auto later = targets_.upper_bound(estimate.t);
  for (auto due = targets_.begin(); due != later; due = targets_.erase(due)) {
    target_ = SpinTarget{.axis_icrf = due->second, .rate = target_ ? target_->rate : std::nullopt};
  }
  const Quality quality = estimate.assessment.quality;
  add(ambiguous_.update(estimate.t, quality == Quality::Ambiguous), changes);
  add(doubtful_.update(estimate.t, quality == Quality::Doubtful), changes);
  add(lost_.update(estimate.t, quality == Quality::Lost), changes);
  if (seconds_between(*first_, estimate.t) >= limits_.sigma_after_s) {
    add(sigma_.update(estimate.t, {.value = sigma_deg_of(estimate), .limit = limits_.sigma_deg}),
        changes);
  }
  if (target_ && is_unopposed(quality)) {
    evaluate_target(estimate, changes);
  }
}

void SpinConditions::evaluate_target(const SpinEstimate& estimate, ConditionChanges& changes) {
  const double sigma_deg = sigma_deg_of(estimate);
  add(off_target_.update(estimate.t,
                         {.value = degrees_between(estimate.axis_icrf, target_->axis_icrf),
                          .limit = limits_.off_target_deg + limits_.off_target_sigmas * sigma_deg,
                          .sigma = sigma_deg}),
      changes);
  if (const auto& rate = target_->rate) {
    add(rate_.update(estimate.t,
                     {.value = kRpmPerRad_s * std::abs(estimate.spin_rate_rad_s - rate->rad_s),
                      .limit = kRpmPerRad_s * rate->tolerance_rad_s,
                      .sigma = kRpmPerRad_s * estimate.spin_rate_sigma_rad_s}),
        changes);
  }
}

void SpinConditions::evaluate_disagreement(ConditionChanges& changes) {
  if (!mean_ || !sequential_ || mean_->assessment.quality != Quality::Ok ||
      sequential_->assessment.quality != Quality::Ok ||
      std::abs(seconds_between(mean_->t, sequential_->t)) > kApartAtMost_s) {
    return;
  }
  const double sigma_deg = difference_sigma_rad(*mean_, *sequential_) * kDegPerRad;
  add(disagree_.update(
          std::max(mean_->t, sequential_->t),
          {.value = degrees_between(mean_->axis_icrf, sequential_->axis_icrf) / sigma_deg,
           .limit = limits_.disagree_sigmas}),
      changes);
}

ConditionChanges SpinConditions::evaluate(const BatchSolution& solution) {
  ConditionChanges changes;
  if (const auto& search = solution.nutation) {
    const auto& found = search->found;
    add(nutation_.update(
            solution.estimate.t,
            found ? reading_of(found->half_angle_rad)
                  : ConditionWatch::Reading{.value = 0.0, .limit = limits_.nutation_deg}),
        changes);
  }
  return changes;
}

/// Compares the half-angle with its limit, or with the smallest one if it has grown significantly.
ConditionWatch::Reading SpinConditions::reading_of(const Estimated& half_angle_rad) {
  ConditionWatch::Reading reading{.value = half_angle_rad.value * kDegPerRad,
                                  .limit = limits_.nutation_deg,
                                  .sigma = half_angle_rad.sigma * kDegPerRad};
  if (least_nutation_rad_) {
    const double grown_deg =
        kDegPerRad *
        (least_nutation_rad_->value +
         kContradictionSigmas * std::hypot(least_nutation_rad_->sigma, half_angle_rad.sigma));
    if (reading.value >= grown_deg) {
      reading.limit = std::min(reading.limit, grown_deg);
    }
  }
  if (!least_nutation_rad_ || half_angle_rad.value < least_nutation_rad_->value) {
    least_nutation_rad_ = half_angle_rad;
  }
  return reading;
}

}  // namespace spindrift
