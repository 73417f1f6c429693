/// @file
/// Detects that usable samples come and that no answer comes of them.

#pragma once

#include <optional>
#include <set>

#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Counts the time of usable samples since the last answer; gaps between them do not count. An
/// answer may be told before or after the samples behind it, since only times are compared.
class AnswerPresence {
 public:
  AnswerPresence(AlertCode code, double limit_s) : limit_s_{limit_s}, watch_{code, "s"} {}

  void set_limit_s(double limit_s) { limit_s_ = limit_s; }
  void see_answer(TaiTime t) { answers_.insert(t); }
  /// @param t Time of a usable sample; one earlier than the sample before is ignored.
  std::optional<ConditionChange> see_sample(TaiTime t);

 private:
  double limit_s_;
  ConditionWatch watch_;
  std::set<TaiTime> answers_;       ///< Times of the answers that no sample has passed yet.
  std::optional<TaiTime> reached_;  ///< Time of the newest sample.
  double without_s_ = 0.0;
};

}  // namespace spindrift
