#include "pipelines/supervision/spin_conditions.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// Noise may put a single answer off; the condition must hold over several.
constexpr Holding kSeveralAnswers{.raise_s = 10.0, .clear_s = 10.0};

constexpr Holding as_long_again(double held_s) { return {.raise_s = held_s, .clear_s = held_s}; }

/// Returns whether an answer could come of the edge, even if it does not.
bool is_usable(const PulseUse& use) {
  constexpr std::array kLeftOut{Rejection::Late, Rejection::OutOfTime, Rejection::Contradicted,
                                Rejection::Copy, Rejection::Operator};
  return !use.rejected_by ||
         std::find(kLeftOut.begin(), kLeftOut.end(), *use.rejected_by) == kLeftOut.end();
}

double sigma_deg_of(const SpinEstimate& estimate) {
  return std::sqrt(estimate.covariance_rad2.trace()) * kDegPerRad;
}

/// @param found An estimate, a fix or an alternate of one.
AxisSeen axis_seen(const auto& found) {
  return {.axis_icrf = found.axis_icrf, .sigma_rad = std::sqrt(found.covariance_rad2.trace())};
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
      sensors_{limits},
      irrational_{limits.period.revolutions, 1},
      left_out_{limits.rejection.revolutions, kPulseChannels},
      interference_{AlertCode::SpinInterference, "edges", {.raise_s = 0.0, .clear_s = 60.0}},
      period_{AlertCode::SpinPeriod, "%"},
      rejection_{AlertCode::SpinRejection, "%"},
      ambiguous_{AlertCode::SpinAmbiguous, "s", as_long_again(limits.ambiguous_s)},
      doubtful_{AlertCode::SpinDoubtful, "s", as_long_again(limits.doubtful_s)},
      sigma_{AlertCode::SpinSigma, "deg"},
      disagree_{AlertCode::SpinDisagree, "sigma", kSeveralAnswers},
      off_target_{AlertCode::SpinOffTarget, "deg", kSeveralAnswers},
      nutation_{AlertCode::SpinNutation, "deg"},
      rate_{AlertCode::SpinRate, "rpm", kSeveralAnswers},
      presence_{AlertCode::SpinNoAnswer, limits.spin_no_answer_s},
      answers_{limits.disagree_sigmas} {}

void SpinConditions::set_limits(const AlertLimits& limits) {
  irrational_.set_turns(limits.period.revolutions);
  left_out_.set_turns(limits.rejection.revolutions);
  channels_.set_silent_revolutions(limits.silent_revolutions);
  sensors_.set_limits(limits);
  ambiguous_.hold(as_long_again(limits.ambiguous_s));
  doubtful_.hold(as_long_again(limits.doubtful_s));
  presence_.set_limit_s(limits.spin_no_answer_s);
  limits_ = limits;
}

void SpinConditions::set_target(TaiTime t, const Eigen::Vector3d& axis_icrf) {
  targets_.emplace(t, axis_icrf);
}

ConditionChanges SpinConditions::evaluate(const PulseUse& use) {
  // A copy is not a further edge of its channel.
  const bool is_copy = use.rejected_by == Rejection::Copy;
  ConditionChanges changes =
      is_copy ? ConditionChanges{} : channels_.evaluate(use.pulse, axes_in_question());
  if (is_usable(use)) {
    add(presence_.see_sample(use.pulse.t), changes);
  }
  add(interference_.update(use.pulse.t, use.rejected_by == Rejection::Interference), changes);
  if (use.revolution || is_copy || use.rejected_by == Rejection::Unassociated ||
      use.rejected_by == Rejection::Late) {
    if (const auto percent = left_out_.count(use.revolution, use.rejected_by.has_value())) {
      add(rejection_.update(use.pulse.t, {.value = *percent, .limit = limits_.rejection.percent}),
          changes);
    }
  }
  return changes;
}

/// Returns the axis of an answer that nothing opposes. Without one, or where it is AMBIGUOUS, the
/// true axis is among those of a fix; where it is DOUBTFUL or LOST it may be anywhere.
std::span<const AxisSeen> SpinConditions::axes_in_question() {
  const auto& answer = answers_.in_force();
  if (!answer || answer->quality == Quality::Ambiguous) {
    return of_last_fix_;
  }
  in_question_.clear();
  if (is_unopposed(answer->quality)) {
    in_question_.push_back(axis_seen(answer->estimate));
  }
  return in_question_;
}

/// A near-tangent fix may lack the true axis.
ConditionChanges SpinConditions::evaluate(const SpinFix& fix) {
  of_last_fix_.clear();
  if (!fix.near_tangent) {
    of_last_fix_.push_back(axis_seen(fix));
    for (const SpinAlternate& other : fix.alternates) {
      of_last_fix_.push_back(axis_seen(other));
    }
  }
  return {};
}

ConditionChanges SpinConditions::evaluate(const RevolutionProduct& revolution) {
  t_sun1_ = revolution.t_sun1;
  return {};
}

ConditionChanges SpinConditions::evaluate(const SpinMeasurement& measurement) {
  ConditionChanges changes;
  if (measurement.quantity != SpinQuantity::Period) {
    return changes;
  }
  const auto percent =
      irrational_.count(measurement.revolution, measurement.rejected_by.has_value());
  if (percent && t_sun1_) {
    add(period_.update(*t_sun1_, {.value = *percent, .limit = limits_.period.percent}), changes);
  }
  return changes;
}

ConditionChanges SpinConditions::evaluate(const SpinEstimate& estimate) {
  ConditionChanges changes;
  // A solution of `batch`, which comes at any time, is weighed by the limit of the newest answer.
  if (estimate.estimator != SpinEstimator::Batch) {
    answers_.set_contradiction_sigmas(limits_.disagree_sigmas);
  }
  answers_.take(estimate);
  presence_.see_answer(estimate.t);
  if (estimate.estimator == SpinEstimator::Batch) {
    return changes;
  }
  const auto later = manoeuvres_.upper_bound(estimate.t);
  if (later != manoeuvres_.begin()) {
    first_.reset();
    manoeuvres_.erase(manoeuvres_.begin(), later);
  }
  first_ = first_.value_or(estimate.t);
  judged_ = std::max(judged_.value_or(estimate.t), estimate.t);
  evaluate_in_force(estimate.t, *answers_.in_force(), changes);
  evaluate_disagreement(estimate.t, changes);
  return changes;
}

void SpinConditions::evaluate_in_force(TaiTime t, const SpinAnswer& answer,
                                       ConditionChanges& changes) {
  const auto later = targets_.upper_bound(t);
  for (auto due = targets_.begin(); due != later; due = targets_.erase(due)) {
    target_ = SpinTarget{.axis_icrf = due->second, .rate = target_ ? target_->rate : std::nullopt};
  }
  evaluate_quality(t, answer.quality, changes);
  if (first_ && seconds_between(*first_, t) >= limits_.sigma_after_s) {
    add(sigma_.update(t, {.value = sigma_deg_of(answer.estimate), .limit = limits_.sigma_deg}),
        changes);
  }
  if (target_ && is_unopposed(answer.quality)) {
    evaluate_target(t, answer.estimate, changes);
  }
}

void SpinConditions::evaluate_quality(TaiTime t, Quality quality, ConditionChanges& changes) {
  add(ambiguous_.update(t, quality == Quality::Ambiguous), changes);
  add(doubtful_.update(t, quality == Quality::Doubtful), changes);
  add(lost_.update(t, quality == Quality::Lost, quality), changes);
}

/// Does not wait, since no answer may come any more that shows that the condition lasts.
ConditionChanges SpinConditions::note_fault(TaiTime t) {
  ConditionChanges changes;
  answers_.note_fault();
  ambiguous_.end();
  doubtful_.end();
  judged_ = std::max(judged_.value_or(t), t) + std::chrono::nanoseconds{1};
  evaluate_quality(*judged_, in_force() ? in_force()->quality : Quality::Doubtful, changes);
  return changes;
}

void SpinConditions::evaluate_target(TaiTime t, const SpinEstimate& estimate,
                                     ConditionChanges& changes) {
  const double sigma_deg = sigma_deg_of(estimate);
  add(off_target_.update(t,
                         {.value = degrees_between(estimate.axis_icrf, target_->axis_icrf),
                          .limit = limits_.off_target_deg + limits_.off_target_sigmas * sigma_deg,
                          .sigma = sigma_deg}),
      changes);
  if (const auto& rate = target_->rate) {
    add(rate_.update(t, {.value = kRpmPerRad_s * std::abs(estimate.spin_rate_rad_s - rate->rad_s),
                         .limit = kRpmPerRad_s * rate->tolerance_rad_s,
                         .sigma = kRpmPerRad_s * estimate.spin_rate_sigma_rad_s}),
        changes);
  }
}

void SpinConditions::evaluate_disagreement(TaiTime t, ConditionChanges& changes) {
  const double limit = answers_.contradiction_sigmas();
  const std::vector<AxesApart> pairs = answers_.apart();
  const auto worst =
      std::max_element(pairs.begin(), pairs.end(),
                       [](const AxesApart& a, const AxesApart& b) { return a.sigmas < b.sigmas; });
  if (worst != pairs.end()) {
    add(disagree_.update(t, {.value = worst->sigmas, .limit = limit}), changes);
  }
}

ConditionChanges SpinConditions::settle() {
  ConditionChanges changes = sensors_.settle();
  const auto& answer = answers_.in_force();
  if (!answer) {
    return changes;
  }
  for (ConditionWatch* const watch :
       {&ambiguous_, &doubtful_, &sigma_, &off_target_, &rate_, &disagree_}) {
    watch->end();
  }
  lost_.end();
  // Behind all that was judged, since a change at the time of another would be taken for known.
  const TaiTime t = std::max(answer->t, judged_.value_or(answer->t)) + std::chrono::nanoseconds{1};
  evaluate_in_force(t, *answer, changes);
  // The solution of the whole pass may be its only answer, behind its last edge.
  add(presence_.see_sample(t), changes);
  evaluate_disagreement(t, changes);
  if (answers_.apart().empty()) {
    add(disagree_.update(t, {.value = 0.0, .limit = answers_.contradiction_sigmas()}), changes);
  }
  if (is_unopposed(answer->quality)) {
    for (ConditionChange& silent : channels_.settle(axis_seen(answer->estimate))) {
      changes.push_back(std::move(silent));
    }
  }
  return changes;
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
