/// @file
/// The alert conditions for samples that contradict each other, in telemetry time.

#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/time/sample_contradiction.h"

namespace spindrift {

/// Watches each source that another contradicts, except the preferred one, because it is unknown
/// which of them is right.
class ContradictionConditions {
 public:
  explicit ContradictionConditions(const AlertLimits& limits)
      : limit_samples_{limits.contradicted_samples} {}

  /// Counts a contradiction, whose senders must be named.
  ConditionChanges evaluate(const SampleContradiction& contradiction);
  /// Advances telemetry time to `t`.
  ConditionChanges evaluate(TaiTime t);

 private:
  struct Source {
    explicit Source(const std::string& name)
        : watch{AlertCode::LinkContradiction, "samples", {}, name} {}
    std::deque<TaiTime> last_minute;  ///< Times of contradictions.
    ConditionWatch watch;
  };

  std::optional<ConditionChange> look(Source& source) const;

  double limit_samples_;
  TaiTime newest_ = TaiTime::min();
  std::map<std::string, Source> sources_;
};

}  // namespace spindrift
