/// @file
/// The candidate for the spin period that each revolution gives: the interval that ends at its edge
/// of the channel that sets the clock, or what the spacecraft said.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "pipelines/spin/association/clock_start.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"
#include "pipelines/spin/types/spin_rate.h"
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
  PeriodCandidate judge(TaiTime from, TaiTime to, std::int64_t turns, double expected_s);
  /// Tests and adds the period of one turn, timed on board.
  PeriodCandidate judge(TaiTime t, double period_s, double expected_s) {
    return judge(t, period_s, 1.0, expected_s);
  }
  /// Returns the candidate of an interval that ends at a rejected edge, without adding it.
  PeriodCandidate refused(TaiTime from, TaiTime to, std::int64_t turns,
                          Rejection rejected_by) const;

  std::size_t size() const { return differences_s_.size(); }

 private:
  PeriodCandidate judge(TaiTime t, double period_s, double turns, double expected_s);

  SpinScreening screening_;
  double candidate_sigma_s_;  ///< One sigma of a candidate over one turn.
  SlidingRobustMean differences_s_;
};

/// Follows the intervals between the edges of the channel that sets the clock.
class PeriodIntervals {
 public:
  /// @param edge_sigma_s One standard deviation of an edge's time.
  PeriodIntervals(const SpinScreening& screening, double edge_sigma_s)
      : screening_{screening}, window_{screening, edge_sigma_s} {}

  /// Starts anew after a change of channel or rate, which no interval may span.
  void begin_anew(double edge_sigma_s);

  /// Keeps a period that the spacecraft stated.
  void keep(const PeriodNote& note);
  void forget_notes_before(TaiTime t);
  std::vector<PeriodNote> notes() const { return {notes_.begin(), notes_.end()}; }

  /// Returns the candidate of a judged revolution; intervals start at the last good edge.
  /// @param reference The channel that sets the clock.
  /// @param expected_s The period that the clock gives for an instant.
  /// @return Empty where there is neither edge nor note, and where an interval only starts.
  std::optional<PeriodCandidate> candidate(const Revolution& revolution, PulseChannel reference,
                                           const std::function<double(TaiTime)>& expected_s);

 private:
  struct IntervalStart {
    TaiTime t;
    std::int64_t revolution;
  };

  std::optional<PeriodCandidate> noted(const Revolution& revolution,
                                       const std::function<double(TaiTime)>& expected_s);

  SpinScreening screening_;
  SpinPeriodWindow window_;
  std::optional<IntervalStart> start_;
  std::deque<PeriodNote> notes_;  ///< The latest notes.
};

}  // namespace spindrift
