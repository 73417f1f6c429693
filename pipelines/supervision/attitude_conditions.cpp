#include "pipelines/supervision/attitude_conditions.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "pipelines/statistics/distributions.h"
#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr double kBetweenJudgements_s = 1.0;
/// Time for which the lost gate is believed after the magnetometer has spoken.
constexpr double kFieldHolds_s = 10.0;

ConditionChanges changes_of(std::optional<ConditionChange> change) {
  return change ? ConditionChanges{std::move(*change)} : ConditionChanges{};
}

/// Returns whether star fixes overruled the former attitude at this instant.
bool begins_anew(const AttitudeEstimate& estimate) {
  const auto& reasons = estimate.assessment.reasons;
  return std::any_of(reasons.begin(), reasons.end(), [&](const Reason& reason) {
    return reason.code == ReasonCode::Since &&
           std::get<std::int64_t>(reason.values.front().value) == tai_ns(estimate.t);
  });
}

/// Gives a lost attitude the numbers of the gate that says so.
void describe(const GateTransition& gate, ConditionChange& change) {
  const GateRule rule = rule_of(gate.gate);
  Evidence& evidence = change.evidence;
  evidence.value = gate.value;
  evidence.limit = rule.threshold;
  evidence.unit = rule.unit;
  evidence.since = gate.since;
  evidence.is_presence = false;
  evidence.more = gate.more;
  evidence.more.push_back({"gate", std::string{name_of(gate.gate)}});
  evidence.more.push_back({"hits", std::int64_t{gate.hits}});
  evidence.more.push_back({"window", std::int64_t{gate.window}});
}

/// Returns the percentage of chi-square values that lie closer to the median.
double percent_nearer(const Innovations& innovations) {
  const double tail =
      chi_square_tail(innovations.squared, static_cast<double>(innovations.freedom));
  return 100.0 * (1.0 - 2.0 * std::min(tail, 1.0 - tail));
}

}  // namespace

AttitudeConditions::AttitudeConditions(const AlertLimits& limits, std::optional<Orbit> orbit,
                                       const ThreeAxisConfig& config)
    : launcher_percent_{limits.launcher_percent},
      diverged_percent_{limits.diverged_percent},
      diverged_s_{limits.diverged_s},
      views_{config, orbit, limits.silent_s},
      kinds_{views_.others(), config, std::move(orbit), limits.silent_s},
      sensors_{limits},
      stuck_{limits.stuck_s},
      // Noise leaves the 99.9 % band in one window of a thousand, but not in two consecutive ones.
      diverged_{AlertCode::AttitudeDiverged,
                "% of chi-square",
                {.raise_s = limits.diverged_s, .clear_s = limits.diverged_s}},
      has_lost_gate_{config.nominal.has_value()},
      doubtful_{AlertCode::AttitudeDoubtful,
                "s",
                {.raise_s = limits.attitude_doubtful_s, .clear_s = limits.attitude_doubtful_s}},
      presence_{AlertCode::AttitudeNoAnswer, limits.attitude_no_answer_s},
      launcher_{AlertCode::ReconstructionLauncher, "% of chi-square"} {}

ConditionChanges AttitudeConditions::await_answer(std::vector<AwaitedSample> samples) {
  ConditionChanges changes;
  for (const AwaitedSample& sample : std::exchange(awaited_, std::move(samples))) {
    add(presence_.see_sample(sample.t, sample.is_usable), changes);
  }
  return changes;
}

void AttitudeConditions::set_limits(const AlertLimits& limits) {
  launcher_percent_ = limits.launcher_percent;
  diverged_percent_ = limits.diverged_percent;
  diverged_s_ = limits.diverged_s;
  diverged_.hold({.raise_s = limits.diverged_s, .clear_s = limits.diverged_s});
  doubtful_.hold({.raise_s = limits.attitude_doubtful_s, .clear_s = limits.attitude_doubtful_s});
  presence_.set_limit_s(limits.attitude_no_answer_s);
  sensors_.set_limits(limits);
  stuck_.set_limit_s(limits.stuck_s);
  kinds_.set_silent_s(limits.silent_s);
  views_.set_silent_s(limits.silent_s);
}

void AttitudeConditions::take_up(AlertCode code, const std::string& about) {
  if (code == AlertCode::SensorContradicts) {
    sensors_.take_up(about);
  } else if (code == AlertCode::SensorStuck) {
    stuck_.take_up(about);
  }
}

ConditionChanges AttitudeConditions::evaluate(const RejectedSample& sample) {
  views_.see_sample(sample.kind, sample.t);
  return stuck_.see_left_out(sample);
}

ConditionChanges AttitudeConditions::evaluate(const SampleObservation& observation) {
  views_.see_sample(kind_of(observation.said.source), observation.said.t);
  if (observation.said.source == SampleSource::Magnetometer) {
    field_ = observation.said.t;
  }
  return {};
}

ConditionChanges AttitudeConditions::evaluate(const GateTransition& transition) {
  if (transition.gate != Gate::Lost) {
    return {};
  }
  lost_gate_ = transition;
  field_ = transition.t;
  last_ = std::max(last_.value_or(transition.t), transition.t);
  return changes_of(see_lost(transition.t, transition.open));
}

/// Where the field is held against that of the commanded attitude, the gate alone decides: the
/// answer may be lost for want of sensors while the body is where it should be.
/// @param by_answer Whether the answer by itself is lost.
bool AttitudeConditions::is_lost(TaiTime t, bool by_answer) const {
  const bool gate_speaks = has_lost_gate_ && field_ && elapsed_s(*field_, t) <= kFieldHolds_s;
  return gate_speaks ? lost_gate_ && lost_gate_->open : by_answer;
}

std::optional<ConditionChange> AttitudeConditions::see_lost(TaiTime t, bool is_lost) {
  auto change = lost_.update(t, is_lost, quality_);
  if (change && change->change == Change::Raised && lost_gate_ && lost_gate_->open) {
    describe(*lost_gate_, *change);
  }
  return change;
}

ConditionChanges AttitudeConditions::evaluate(const AttitudeEstimate& estimate) {
  ConditionChanges changes = sensors_.evaluate(estimate.t, estimate.contradiction);
  std::ranges::move(stuck_.see_answer(estimate.t), std::back_inserter(changes));
  std::ranges::move(views_.see_answer(estimate), std::back_inserter(changes));
  presence_.see_answer(estimate.t);
  quality_ = at_best(estimate.assessment.quality);
  add(doubtful_.update(estimate.t, quality_ == Quality::Doubtful), changes);
  const bool by_answer = quality_ == Quality::Lost || begins_anew(estimate);
  add(see_lost(estimate.t, is_lost(estimate.t, by_answer)), changes);
  add(see_innovations(estimate), changes);
  last_ = estimate.t;
  return changes;
}

Quality AttitudeConditions::at_best(Quality quality) const {
  return has_failed_ ? std::max(quality, Quality::Doubtful) : quality;
}

/// Does not wait, since no answer may come any more that shows that the condition lasts.
ConditionChanges AttitudeConditions::note_fault(TaiTime t) {
  ConditionChanges changes;
  has_failed_ = true;
  quality_ = at_best(quality_);
  doubtful_.end();
  last_ = std::max(last_.value_or(t), t) + std::chrono::nanoseconds{1};
  add(doubtful_.update(*last_, quality_ == Quality::Doubtful), changes);
  return changes;
}

ConditionChanges AttitudeConditions::settle() {
  ConditionChanges changes = await_answer({});
  std::ranges::move(sensors_.settle(), std::back_inserter(changes));
  if (last_) {
    lost_.end();
    doubtful_.end();
    // Behind all that was judged, since a change at the time of another would be taken for known.
    const TaiTime t = *last_ + std::chrono::nanoseconds{1};
    add(see_lost(t, is_lost(*last_, quality_ == Quality::Lost)), changes);
    add(doubtful_.update(t, quality_ == Quality::Doubtful), changes);
    // One window outside the band may be noise, so that the last one alone raises nothing.
    if (percent_ && *percent_ < diverged_percent_) {
      diverged_.end();
      add(diverged_.update(t, {.value = *percent_, .limit = diverged_percent_}), changes);
    }
  }
  return changes;
}

std::optional<ConditionChange> AttitudeConditions::see_innovations(
    const AttitudeEstimate& estimate) {
  if (estimate.assessment.quality == Quality::Lost) {
    recent_.clear();
    return std::nullopt;
  }
  recent_.push_back({.t = estimate.t, .innovations = estimate.innovations});
  const bool is_whole = seconds_between(recent_.front().t, estimate.t) >= diverged_s_;
  while (seconds_between(recent_.front().t, estimate.t) >= diverged_s_) {
    recent_.pop_front();
  }
  if (!is_whole || (judged_ && seconds_between(*judged_, estimate.t) < kBetweenJudgements_s)) {
    return std::nullopt;
  }
  judged_ = estimate.t;
  Innovations sum;
  for (const Recent& one : recent_) {
    sum.squared += one.innovations.squared;
    sum.freedom += one.innovations.freedom;
  }
  if (sum.freedom == 0) {
    return std::nullopt;
  }
  percent_ = percent_nearer(sum);
  return diverged_.update(estimate.t, {.value = *percent_, .limit = diverged_percent_});
}

ConditionChanges AttitudeConditions::evaluate(const ReconstructedSeparation& separation) {
  // Only `batch` counts, which uses all samples together.
  if (separation.solution.method != ReconstructionMethod::Batch || !separation.launcher ||
      !*separation.launcher) {
    return {};
  }
  return changes_of(launcher_.update(
      separation.solution.history.back().t,
      {.value = 100.0 * (1.0 - (**separation.launcher).chance), .limit = launcher_percent_}));
}

}  // namespace spindrift
