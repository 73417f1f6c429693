/// @file
/// The rationality test of the intervals between successive edges of one channel.

#pragma once

#include <cstddef>
#include <cstdint>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/spin_period.h"
#include "pipelines/statistics/robust_mean.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Sliding window of period candidates: one alone is unreliable. What is tested is by how much each
/// differs from the period expected at its time, so that a rate that drifts widens no limit.
///
/// Rejected candidates stay in the window: when the rate really changes they become the majority,
/// and the test follows.
class SpinPeriodWindow {
 public:
  /// @param edge_sigma_s One standard deviation of an edge's time.
  SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s);

  /// Tests the interval `from` -> `to`, `turns` > 0 revolutions long, and adds it.
  PeriodCandidate add(TaiTime from, TaiTime to, std::int64_t turns, double expected_s);
  /// The same for one turn timed elsewhere.
  PeriodCandidate add(double period_s, double expected_s) { return add(period_s, 1.0, expected_s); }
  /// An interval that ends at an edge that was rejected, as it is with that: it is not added.
  PeriodCandidate refused(TaiTime from, TaiTime to, std::int64_t turns,
                          Rejection rejected_by) const;

  std::size_t size() const { return differences_s_.size(); }

 private:
  PeriodCandidate add(double period_s, double turns, double expected_s);

  SpinScreening screening_;
  double candidate_sigma_s_;  ///< Of one turn.
  SlidingRobustMean differences_s_;
};

}  // namespace spindrift
