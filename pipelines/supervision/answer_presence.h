/// @file
/// Detects that samples come and that no answer comes of them.

#pragma once

#include <optional>
#include <set>

#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// Counts the time of samples since the last answer; gaps between them do not count. Samples that
/// alone make no answer are waited with five times as long. An answer may be told before or after
/// the samples behind it, since only times are compared.
class AnswerPresence {
 public:
  AnswerPresence(AlertCode code, double limit_s) : limit_s_{limit_s}, watch_{code, "s"} {}

  void set_limit_s(double limit_s) { limit_s_ = limit_s; }
  void see_answer(TaiTime t) { answers_.insert(t); }
  /// @param t Time of a sample; one earlier than another of its kind before is ignored.
  /// @param is_usable Whether an answer can be made of such samples.
  std::optional<ConditionChange> see_sample(TaiTime t, bool is_usable = true);

 private:
  struct Waited {
    std::optional<TaiTime> reached = {};  ///< Time of the newest sample.
    double without_s = 0.0;

    void see(TaiTime t);
  };

  double limit_s_;
  ConditionWatch watch_;
  std::set<TaiTime> answers_;  ///< Times of the answers that no sample has passed yet.
  Waited all_;
  Waited usable_;
};

}  // namespace spindrift
