#include "pipelines/supervision/condition_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift {
namespace {

bool has_moved(double value, double told) {
  return std::abs(value - told) > ConditionWatch::kMovedShare * std::abs(told);
}

}  // namespace

ConditionWatch::ConditionWatch(AlertCode code, std::string_view unit, Holding holding,
                               std::string about)
    : code_{code}, about_{std::move(about)}, unit_{unit}, holding_{holding} {}

std::optional<ConditionChange> ConditionWatch::update(TaiTime t, const Reading& reading) {
  return judge(t, reading, reading.value >= reading.limit,
               reading.value <= clear_share_ * reading.limit);
}

std::optional<ConditionChange> ConditionWatch::see_least(TaiTime t, const Reading& reading) {
  return judge(t, reading, reading.value < reading.limit,
               clear_share_ * reading.value >= reading.limit);
}

std::optional<ConditionChange> ConditionWatch::judge(TaiTime t, const Reading& reading,
                                                     bool is_there, bool is_gone) {
  const Evidence evidence{.value = reading.value,
                          .limit = reading.limit,
                          .unit = unit_,
                          .since = t,
                          .last = t,
                          .sigma = reading.sigma};
  if ((is_there || is_gone) && settle(t, is_there ? Change::Raised : Change::Cleared)) {
    return tell_settled(evidence);
  }
  return renew(evidence);
}

std::optional<ConditionChange> ConditionWatch::update(TaiTime t, bool is_there) {
  const bool is_news = settle(t, is_there ? Change::Raised : Change::Cleared);
  const TaiTime since = told_ && !is_news ? told_->evidence.since : since_;
  const bool is_presence = unit_ != "s" && holding_.raise_s <= 0.0;
  const Evidence evidence{.value = !is_presence ? seconds_between(since, t)
                                   : is_there   ? 1.0
                                                : 0.0,
                          .limit = is_presence ? 1.0 : holding_.raise_s,
                          .unit = is_presence ? unit_ : "s",
                          .since = since,
                          .last = t,
                          .is_presence = is_presence};
  if (is_news) {
    return tell_settled(evidence);
  }
  // Without a limit, for how long the condition holds is nothing to tell.
  return is_there && evidence.limit > 0.0 ? renew(evidence) : std::nullopt;
}

void ConditionWatch::end() {
  holding_ = {};
  clear_share_ = 1.0;
  last_.reset();
}

/// Returns whether a reading raises or clears the condition.
bool ConditionWatch::settle(TaiTime t, Change now) {
  if (last_ && (t < *last_ || (t == *last_ && now == Change::Cleared))) {
    return false;
  }
  last_ = t;
  if (coming_ != now) {
    coming_ = now;
    since_ = t;
  }
  const double held_s = now == Change::Raised ? holding_.raise_s : holding_.clear_s;
  if (said_ == now || seconds_between(since_, t) < held_s) {
    return false;
  }
  said_ = now;
  return true;
}

ConditionChange ConditionWatch::tell(Change change, const Evidence& evidence) const {
  return {.code = code_,
          .about = about_,
          .change = change,
          .t = evidence.last,
          .evidence = evidence,
          .severity = severity_of(code_)};
}

ConditionChange ConditionWatch::tell_settled(Evidence evidence) {
  evidence.since = since_;
  worst_ = evidence.value;
  is_least_ = evidence.value < evidence.limit;
  told_ = said_ == Change::Raised ? std::optional{Told{evidence, worst_}} : std::nullopt;
  return tell(*said_, evidence);
}

std::optional<ConditionChange> ConditionWatch::renew(Evidence evidence) {
  if (!told_) {
    return std::nullopt;
  }
  const auto& [before, told_worst] = *told_;
  worst_ = is_least_ ? std::min(worst_, evidence.value) : std::max(worst_, evidence.value);
  if (seconds_between(before.last, evidence.last) < kBetweenTold_s ||
      !(has_moved(evidence.value, before.value) || has_moved(worst_, told_worst))) {
    return std::nullopt;
  }
  evidence.since = before.since;
  evidence.worst = worst_;
  told_ = Told{evidence, worst_};
  return tell(Change::Renewed, evidence);
}

}  // namespace spindrift
