/// @file
/// The alert conditions for samples and products of a three-axis spacecraft, in telemetry time.

#pragma once

#include <deque>
#include <optional>

#include "pipelines/reconstruction/separation.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/kind_presence.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/sensor_conditions.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

class AttitudeConditions {
 public:
  /// @param orbit Orbit for the prediction of eclipses; empty if unknown.
  AttitudeConditions(const AlertLimits& limits, std::optional<Orbit> orbit);

  ConditionChanges evaluate(SampleKind kind, TaiTime t) { return kinds_.evaluate(kind, t); }
  ConditionChanges evaluate(const AttitudeEstimate& estimate);
  ConditionChanges evaluate(const ReconstructedSeparation& separation);

 private:
  std::optional<ConditionChange> see_innovations(const AttitudeEstimate& estimate);

  double launcher_percent_;
  double diverged_percent_;
  double diverged_s_;
  KindPresence kinds_;
  SensorConditions sensors_;
  struct Recent {
    TaiTime t;
    Innovations innovations;
  };
  std::deque<Recent> recent_;      ///< Estimates of the last `diverged_s_` seconds.
  std::optional<TaiTime> judged_;  ///< Time of the last test of `recent_`.
  ConditionWatch diverged_;
  ConditionWatch lost_;
  ConditionWatch launcher_;
};

}  // namespace spindrift
