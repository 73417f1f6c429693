#include "services/processor/reach_watch.h"

#include <algorithm>

#include "pipelines/time/time_span.h"

namespace spindrift {

void ReachWatch::include(TaiTime t) {
  first_ = std::min(first_.value_or(t), t);
  if (contact_ && contact_->from <= t && t < contact_->to) {
    spans_.insert((t - contact_->from) / kSpan);
  }
}

void ReachWatch::carry_on(TaiTime t) {
  if (last_ && t <= *last_) {
    return;
  }
  if (last_ && span_between(*last_, t) > kSilence) {
    ++silences_.count;
    if (span_between(*last_, t) > span_between(silences_.longest_from, silences_.longest_to)) {
      silences_.longest_from = *last_;
      silences_.longest_to = t;
    }
  }
  last_ = t;
}

RunReach ReachWatch::reach() const {
  RunReach reach{.first = *first_, .last = last_.value_or(*first_)};
  if (contact_) {
    const std::chrono::nanoseconds planned = contact_->to - contact_->from;
    const auto spans = (planned + kSpan - std::chrono::nanoseconds{1}) / kSpan;
    reach.contact_share = static_cast<double>(spans_.size()) / static_cast<double>(spans);
  }
  return reach;
}

std::optional<RunReach> ReachWatch::take_news() {
  if (!first_) {
    return std::nullopt;
  }
  const RunReach now = reach();
  const bool is_news =
      !stored_ || now.first < stored_->first || span_between(stored_->last, now.last) >= kFollows;
  return is_news ? (stored_ = now) : std::nullopt;
}

std::optional<RunReach> ReachWatch::take_last() {
  return first_ ? (stored_ = reach()) : std::nullopt;
}

}  // namespace spindrift
