/// @file
/// The alert conditions for sensors that contradict each other, in telemetry time.

#pragma once

#include <map>
#include <optional>
#include <string>

#include "pipelines/observation/sensor_contradiction.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"

namespace spindrift {

class SensorConditions {
 public:
  explicit SensorConditions(const AlertLimits& limits) : limit_sigmas_{limits.contradicts_sigmas} {}

  void set_limits(const AlertLimits& limits) { limit_sigmas_ = limits.contradicts_sigmas; }
  /// @param found Contradiction at `t`; empty if there is none.
  ConditionChanges evaluate(TaiTime t, const std::optional<SensorContradiction>& found);
  /// Takes up the open alert about a culprit, which ends if the culprit is not found any more.
  void take_up(const std::string& culprit) { culprits_.try_emplace(culprit, culprit); }
  /// Settles the conditions by what was found last, without hold.
  ConditionChanges settle();

 private:
  struct Culprit {
    explicit Culprit(const std::string& name);
    ConditionWatch watch;
    std::optional<SensorContradiction> last = {};  ///< The last one found.
  };

  double limit_sigmas_;
  std::map<std::string, Culprit> culprits_;  ///< Culprits by name.
  std::optional<TaiTime> judged_;            ///< When the sensors were compared last.
  std::optional<SensorContradiction> now_;   ///< What was found then.
};

}  // namespace spindrift
