/// @file
/// The alert conditions for products of a spinner, in telemetry time.
///
/// Each condition reads one kind of product or results only, because results and details arrive
/// separately, each in its own order.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/statistics/turn_share.h"
#include "pipelines/supervision/answer_in_force.h"
#include "pipelines/supervision/answer_presence.h"
#include "pipelines/supervision/channel_presence.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/lost_watch.h"
#include "pipelines/supervision/sensor_conditions.h"

namespace spindrift {

/// Watches the answer in force (answer_in_force.h). It is judged whenever `sequential` or `mean`
/// gives an answer, since solutions of `batch` come at any time, and at the end of the run.
class SpinConditions {
 public:
  SpinConditions(const SpinConfig& config, Orbit orbit, const AlertLimits& limits,
                 std::optional<SpinTarget> target);

  /// Sets the target axis for estimates from `t` on; the target rate stays.
  void set_target(TaiTime t, const Eigen::Vector3d& axis_icrf);
  /// Sets the limits of what is evaluated from now on. What has been evaluated is not forgotten, so
  /// that limits may change to and fro with the times of what comes next.
  void set_limits(const AlertLimits& limits);
  /// Announces a manoeuvre at `t`, after which a large axis sigma is expected for a while.
  void note_manoeuvre(TaiTime t) {
    manoeuvres_.insert(t);
    answers_.note_manoeuvre(t);
  }
  /// Notes that the computation of the run failed at `t`: no answer is better than DOUBTFUL now.
  ConditionChanges note_fault(TaiTime t);
  /// Takes up the alert of a run before that is open, if only a watch for it can end it.
  void take_up(AlertCode code, const std::string& about) {
    if (code == AlertCode::SensorContradicts) {
      sensors_.take_up(about);
    }
  }
  /// Returns the target as of the last estimate.
  const std::optional<SpinTarget>& target() const { return target_; }
  const std::optional<SpinAnswer>& in_force() const { return answers_.in_force(); }

  ConditionChanges evaluate(const PulseUse& use);
  ConditionChanges evaluate(const RevolutionProduct& revolution);
  ConditionChanges evaluate(const SpinMeasurement& measurement);
  ConditionChanges evaluate(const SpinFix& fix);
  ConditionChanges evaluate(const SpinEstimate& estimate);
  ConditionChanges evaluate(const BatchSolution& solution);
  ConditionChanges evaluate(const SensorsCompared& sensors) {
    return sensors_.evaluate(sensors.t, sensors.contradiction);
  }

  /// Settles the conditions of the answer by the final one, and those of the sensors by their last
  /// comparison, without hold. To be called once, when the run has ended.
  ConditionChanges settle();

 private:
  std::span<const AxisSeen> axes_in_question();
  void evaluate_in_force(TaiTime t, const SpinAnswer& answer, ConditionChanges& changes);
  void evaluate_quality(TaiTime t, Quality quality, ConditionChanges& changes);
  void evaluate_target(TaiTime t, const SpinEstimate& estimate, ConditionChanges& changes);
  void evaluate_disagreement(TaiTime t, ConditionChanges& changes);
  ConditionWatch::Reading reading_of(const Estimated& half_angle_rad);

  AlertLimits limits_;
  std::optional<SpinTarget> target_;
  std::multimap<TaiTime, Eigen::Vector3d> targets_;  ///< Future target axes, ICRF.
  ChannelPresence channels_;
  SensorConditions sensors_;
  std::vector<AxisSeen> of_last_fix_;  ///< Axes that the last fix leaves possible.
  std::vector<AxisSeen> in_question_;  ///< Axis of an answer that nothing opposes.
  TurnShare irrational_;
  TurnShare left_out_;
  ConditionWatch interference_;
  ConditionWatch period_;
  ConditionWatch rejection_;
  ConditionWatch ambiguous_;
  ConditionWatch doubtful_;
  ConditionWatch sigma_;
  ConditionWatch disagree_;
  ConditionWatch off_target_;
  ConditionWatch nutation_;
  ConditionWatch rate_;
  LostWatch lost_;
  AnswerPresence presence_;
  std::optional<TaiTime> t_sun1_;  ///< Sun edge of the last revolution that has a usable one.
  std::optional<TaiTime> first_;   ///< First estimate since start or manoeuvre.
  std::set<TaiTime> manoeuvres_;   ///< Times of future manoeuvres.
  std::optional<TaiTime> judged_;  ///< When the answer in force was judged last.
  SpinAnswers answers_;
  std::optional<Estimated> least_nutation_rad_;  ///< Smallest half-angle found.
};

}  // namespace spindrift
