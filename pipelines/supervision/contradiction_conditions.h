/// @file
/// The alert conditions for samples that contradict each other, in telemetry time.

#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
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

  /// Sets the limits of what is evaluated from now on.
  void set_limits(const AlertLimits& limits) { limit_samples_ = limits.contradicted_samples; }

  /// Takes up the open alert about a source, which ends if nothing contradicts the source.
  void take_up(const std::string& source) { sources_.try_emplace(source, source); }

  /// Counts a contradiction, whose senders must be named.
  ConditionChanges evaluate(const SampleContradiction& contradiction);
  /// Advances telemetry time to `t`.
  ConditionChanges evaluate(TaiTime t);

 private:
  struct Source {
    explicit Source(const std::string& name)
        : watch{AlertCode::LinkContradiction, "samples", {}, name} {}
    std::deque<TaiTime> last_minute;  ///< Times of contradictions.
    std::set<std::string> involved;   ///< Sources of the last one.
    ConditionWatch watch;
  };

  std::optional<ConditionChange> look(const std::string& name, Source& source) const;

  double limit_samples_;
  TaiTime newest_ = TaiTime::min();
  std::map<std::string, Source> sources_;
};

}  // namespace spindrift
