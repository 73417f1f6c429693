/// @file
/// Decides whether the answer in force is lost.

#pragma once

#include "pipelines/core/assessment.h"
#include "pipelines/supervision/condition_watch.h"

namespace spindrift {

/// An answer that was lost counts as lost until it has been OK for ten seconds.
class LostWatch {
 public:
  /// @param is_lost Whether the answer is lost at `t`.
  std::optional<ConditionChange> update(TaiTime t, bool is_lost, Quality quality) {
    const bool is_there = is_lost || (was_lost_ && quality != Quality::Ok);
    auto change = watch_.update(t, is_there);
    was_lost_ = is_there || (was_lost_ && !(change && change->change == Change::Cleared));
    return change;
  }

  /// Makes the next answer final: it alone decides, at once.
  void end() {
    was_lost_ = false;
    watch_.end();
  }

 private:
  ConditionWatch watch_{AlertCode::AttitudeLost, "answers", {.raise_s = 0.0, .clear_s = 10.0}};
  bool was_lost_ = false;
};

}  // namespace spindrift
