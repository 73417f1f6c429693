/// @file
/// The alert conditions for samples and products of a three-axis spacecraft, in telemetry time.

#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/reconstruction/separation.h"
#include "pipelines/supervision/answer_presence.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/kind_presence.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/lost_watch.h"
#include "pipelines/supervision/sensor_conditions.h"
#include "pipelines/supervision/stuck_sensors.h"
#include "pipelines/supervision/view_presence.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

/// A sample that should lead to an attitude.
struct AwaitedSample {
  TaiTime t;
  bool is_usable;  ///< Whether an attitude can be made of such samples.
};

class AttitudeConditions {
 public:
  /// @param orbit Orbit for the prediction of eclipses; empty if unknown.
  /// @param config Sensors, of which the fields of view count.
  AttitudeConditions(const AlertLimits& limits, std::optional<Orbit> orbit,
                     const ThreeAxisConfig& config = {});

  /// Sets the limits of what is evaluated from now on. What has been evaluated is not forgotten, so
  /// that limits may change to and fro with the times of what comes next.
  void set_limits(const AlertLimits& limits);

  /// Takes up the alert of a run before that is open, if only a watch for it can end it.
  void take_up(AlertCode code, const std::string& about);

  ConditionChanges evaluate(SampleKind kind, TaiTime t) { return kinds_.evaluate(kind, t); }
  /// Awaits an answer of samples: of those given before, if their answers have come by now. To be
  /// called with the samples as they come.
  ConditionChanges await_answer(std::vector<AwaitedSample> samples);
  ConditionChanges evaluate(const AttitudeEstimate& estimate);
  ConditionChanges evaluate(const SensorsCompared& sensors) {
    return sensors_.evaluate(sensors.t, sensors.contradiction);
  }
  ConditionChanges evaluate(const RejectedSample& sample);
  ConditionChanges evaluate(const SampleObservation& observation);
  ConditionChanges evaluate(const GateTransition& transition);
  ConditionChanges evaluate(const ReconstructedSeparation& separation);

  /// Notes that the computation of the run failed at `t`: no answer is better than DOUBTFUL now.
  ConditionChanges note_fault(TaiTime t);

  /// Settles the conditions of the answer and of the sensors by the last answer, without hold. To
  /// be called once, when the run has ended.
  ConditionChanges settle();

 private:
  Quality at_best(Quality quality) const;
  bool is_lost(TaiTime t, bool by_answer) const;
  std::optional<ConditionChange> see_lost(TaiTime t, bool is_lost);
  std::optional<ConditionChange> see_innovations(const AttitudeEstimate& estimate);

  double launcher_percent_;
  double diverged_percent_;
  double diverged_s_;
  ViewPresence views_;  ///< Tells what a sensor with a field of view should see.
  KindPresence kinds_;  ///< All other sensors.
  SensorConditions sensors_;
  StuckSensors stuck_;
  struct Recent {
    TaiTime t;
    Innovations innovations;
  };
  std::deque<Recent> recent_;      ///< Estimates of the last `diverged_s_` seconds.
  std::optional<TaiTime> judged_;  ///< Time of the last test of `recent_`.
  std::optional<double> percent_;  ///< Result of that test.
  ConditionWatch diverged_;
  LostWatch lost_;
  bool has_lost_gate_;
  std::optional<GateTransition> lost_gate_;  ///< Its last transition.
  std::optional<TaiTime> field_;             ///< When the magnetometer last spoke.
  ConditionWatch doubtful_;
  AnswerPresence presence_;
  std::vector<AwaitedSample> awaited_;  ///< Samples whose answers may not have come yet.
  std::optional<TaiTime> last_;         ///< Time of the answer in force, or of a fault behind it.
  Quality quality_ = Quality::Converging;  ///< Quality of that answer.
  bool has_failed_ = false;                ///< Whether the computation failed.
  ConditionWatch launcher_;
};

}  // namespace spindrift
