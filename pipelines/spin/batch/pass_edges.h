/// @file
/// What the estimator `batch` needs of a pass, gathered from its products as they arise.

#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/spin/batch/pass_model.h"
#include "pipelines/spin/batch/starting_axes.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/spin_action.h"

namespace spindrift {

class PassEdges {
 public:
  void note(const SpinProduct& product);

  /// An operator's word on telemetry from `t` on: what it leaves out is forgotten, and at the first
  /// edge behind a manoeuvre all before it.
  void act(TaiTime t, const SpinAction& action);

  /// A day of six edges a turn at 100 rpm: memory is not for ever. Of more they are the last.
  static constexpr std::size_t kMost = 900'000;

  /// Forgets all but so many of the last revolutions.
  void keep_last(std::int64_t revolutions);

  /// When the last of them was: the time of the solution of all. Empty: there are none.
  std::optional<TaiTime> last() const;

  /// As the other estimators say (CopiesInNoise).
  bool noise_chose_among_copies() const { return noise_chose_among_copies_; }

  /// More than `kMost` came.
  bool forgot_some() const { return forgot_some_; }

  /// All edges that a revolution had a place for, in order of time; those too whose angles failed
  /// their test, as an angle rests on several edges and the fit finds the one.
  std::vector<PassEdge> edges() &&;

  /// Axes of the other estimators, which settle it where `sequential` is OK; where it is not, all
  /// that the last fix leaves. Without any, where the mission expects the axis.
  StartingAxes starts(const std::optional<SpinPrior>& prior) const;

 private:
  void take(const PulseUse& use);
  void take(const SpinFix& fix) { last_fix_ = fix; }
  void take(const SpinEstimate& estimate);
  template <class Other>
  void take(const Other& /*product*/) {}

  void forget_before(TaiTime t);

  std::vector<PassEdge> edges_;
  Exclusions<PulseChannel> excluded_;
  std::set<TaiTime> manoeuvres_;  ///< To come.
  std::int64_t last_revolution_ = 0;
  bool forgot_some_ = false;
  bool noise_chose_among_copies_ = false;
  std::optional<SpinEstimate> mean_;
  std::optional<SpinEstimate> sequential_;
  std::optional<SpinFix> last_fix_;
};

}  // namespace spindrift
