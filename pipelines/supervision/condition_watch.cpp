#include "pipelines/supervision/condition_watch.h"

#include <utility>

namespace spindrift {

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
  if (!is_there && !is_gone) {
    return std::nullopt;
  }
  return settle(t, is_there ? Change::Raised : Change::Cleared,
                {.value = reading.value,
                 .limit = reading.limit,
                 .unit = unit_,
                 .since = t,
                 .last = t,
                 .sigma = reading.sigma});
}

std::optional<ConditionChange> ConditionWatch::update(TaiTime t, bool is_there) {
  auto change =
      settle(t, is_there ? Change::Raised : Change::Cleared,
             {.value = 0.0, .limit = holding_.raise_s, .unit = "s", .since = t, .last = t});
  if (change) {
    change->evidence.value = seconds_between(change->evidence.since, t);
  }
  return change;
}

void ConditionWatch::end() {
  holding_ = {};
  clear_share_ = 1.0;
  last_.reset();
}

std::optional<ConditionChange> ConditionWatch::settle(TaiTime t, Change now, Evidence evidence) {
  if (last_ && (t < *last_ || (t == *last_ && now == Change::Cleared))) {
    return std::nullopt;
  }
  last_ = t;
  if (coming_ != now) {
    coming_ = now;
    since_ = t;
  }
  const double held_s = now == Change::Raised ? holding_.raise_s : holding_.clear_s;
  if (said_ == now || seconds_between(since_, t) < held_s) {
    return std::nullopt;
  }
  said_ = now;
  evidence.since = since_;
  return ConditionChange{.code = code_,
                         .about = about_,
                         .change = now,
                         .t = t,
                         .evidence = evidence,
                         .severity = severity_of(code_)};
}

}  // namespace spindrift
