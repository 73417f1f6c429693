/// @file
/// What is worth an alert in samples that contradict each other, in telemetry time.

#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/time/sample_contradiction.h"

namespace spindrift {

/// About each source that another one contradicts, but for the preferred one: nobody knows which of
/// them is right.
class ContradictionConditions {
 public:
  explicit ContradictionConditions(const AlertLimits& limits)
      : limit_samples_{limits.contradicted_samples} {}

  /// With the names of its senders.
  ConditionChanges see(const SampleContradiction& contradiction);
  /// Something was computed of `t`.
  ConditionChanges see(TaiTime t);

 private:
  struct Source {
    explicit Source(const std::string& name)
        : watch{AlertCode::LinkContradiction, "samples", {}, name} {}
    std::deque<TaiTime> last_minute;  ///< When it was contradicted.
    ConditionWatch watch;
  };

  std::optional<ConditionChange> look(Source& source) const;

  double limit_samples_;
  TaiTime newest_ = TaiTime::min();
  std::map<std::string, Source> sources_;
};

}  // namespace spindrift
