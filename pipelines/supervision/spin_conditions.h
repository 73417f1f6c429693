/// @file
/// What is worth an alert in the products of a spinner, in telemetry time.
///
/// Each condition reads one kind of product, or results only: results and details reach it by
/// different ways, each in its own order.

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/supervision/channel_presence.h"
#include "pipelines/supervision/condition_watch.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/supervision/recent_share.h"

namespace spindrift {

/// The answer in force is that of `sequential`; until there is one, that of `mean`.
class SpinConditions {
 public:
  SpinConditions(const SpinConfig& config, Orbit orbit, const AlertLimits& limits,
                 std::optional<SpinTarget> target);

  /// For estimates from `t` on; the rate stays as it was.
  void set_target(TaiTime t, const Eigen::Vector3d& axis_icrf);
  /// The axis moves at `t`: its sigma is wide for a while.
  void note_manoeuvre(TaiTime t) { manoeuvres_.insert(t); }
  /// Of the last estimate.
  const std::optional<SpinTarget>& target() const { return target_; }

  ConditionChanges see(const PulseUse& use);
  ConditionChanges see(const RevolutionProduct& revolution);
  ConditionChanges see(const SpinMeasurement& measurement);
  ConditionChanges see(const SpinEstimate& estimate);
  ConditionChanges see(const BatchSolution& solution);

 private:
  void see_in_force(const SpinEstimate& estimate, ConditionChanges& changes);
  void see_target(const SpinEstimate& estimate, ConditionChanges& changes);
  void see_disagreement(ConditionChanges& changes);
  ConditionWatch::Reading reading_of(const Estimated& half_angle_rad);

  AlertLimits limits_;
  std::optional<SpinTarget> target_;
  std::multimap<TaiTime, Eigen::Vector3d> targets_;  ///< To come: axes.
  ChannelPresence channels_;
  RecentShare irrational_;
  RecentShare left_out_;
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
  ConditionWatch lost_;
  std::map<std::int64_t, TaiTime> t_sun1_;  ///< Of revolutions whose period is to come.
  std::optional<TaiTime> first_;            ///< Estimate, or first since a manoeuvre.
  std::set<TaiTime> manoeuvres_;            ///< To come.
  std::optional<SpinEstimate> mean_;
  std::optional<SpinEstimate> sequential_;
  std::optional<Estimated> least_nutation_rad_;  ///< Half-angle, of those found.
};

}  // namespace spindrift
