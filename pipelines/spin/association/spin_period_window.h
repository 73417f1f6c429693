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

/// Tests period candidates in a sliding window, since one alone is unreliable. It tests by how much
/// each differs from the period expected at its time, so that a drifting rate widens no limit.
///
/// Rejected candidates stay in the window: when the rate really changes they become the majority,
/// and the test follows.
class SpinPeriodWindow {
 public:
  /// @param edge_sigma_s One standard deviation of an edge's time.
  SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s);

  /// Tests the interval `from` -> `to`, `turns` > 0 revolutions long, and adds it.
  PeriodCandidate add(TaiTime from, TaiTime to, std::int64_t turns, double expected_s);
  /// Tests and adds the period of one turn, timed on board.
  PeriodCandidate add(double period_s, double expected_s) { return add(period_s, 1.0, expected_s); }
  /// Returns the candidate of an interval that ends at a rejected edge, without adding it.
  PeriodCandidate refused(TaiTime from, TaiTime to, std::int64_t turns,
                          Rejection rejected_by) const;

  std::size_t size() const { return differences_s_.size(); }

 private:
  PeriodCandidate add(double period_s, double turns, double expected_s);

  SpinScreening screening_;
  double candidate_sigma_s_;  ///< One sigma of a candidate over one turn.
  SlidingRobustMean differences_s_;
};

}  // namespace spindrift
