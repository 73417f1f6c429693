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

 private:
  double limit_sigmas_;
  std::map<std::string, ConditionWatch> watches_;  ///< Watches by the name of the culprit.
};

}  // namespace spindrift
