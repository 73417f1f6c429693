/// @file
/// What is worth an alert in the samples and the products of a three-axis spacecraft, in telemetry
/// time.

#pragma once

#include <deque>
#include <optional>

#include "pipelines/reconstruction/separation.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/kind_presence.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

class AttitudeConditions {
 public:
  /// @param orbit Empty: nobody knows when the Earth hides the Sun.
  AttitudeConditions(const AlertLimits& limits, std::optional<Orbit> orbit);

  /// A sample of that kind came.
  ConditionChanges see(SampleKind kind, TaiTime t) { return kinds_.see(kind, t); }
  ConditionChanges see(const AttitudeEstimate& estimate);
  ConditionChanges see(const ReconstructedSeparation& separation);

 private:
  std::optional<ConditionChange> see_innovations(const AttitudeEstimate& estimate);

  double launcher_percent_;
  double diverged_percent_;
  double diverged_s_;
  KindPresence kinds_;
  struct Recent {
    TaiTime t;
    Innovations innovations;
  };
  std::deque<Recent> recent_;      ///< Of the last `diverged_s_`, since the filter began.
  std::optional<TaiTime> judged_;  ///< When those were, last.
  ConditionWatch diverged_;
  ConditionWatch lost_;
  ConditionWatch launcher_;
};

}  // namespace spindrift
