/// @file
/// What is worth an alert in the products of a three-axis spacecraft, in telemetry time.

#pragma once

#include "pipelines/reconstruction/separation.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

class AttitudeConditions {
 public:
  explicit AttitudeConditions(const AlertLimits& limits);

  ConditionChanges see(const AttitudeEstimate& estimate);
  ConditionChanges see(const ReconstructedSeparation& separation);

 private:
  double launcher_percent_;
  ConditionWatch lost_;
  ConditionWatch launcher_;
};

}  // namespace spindrift
