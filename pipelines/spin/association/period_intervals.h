/// @file
/// The candidate for the spin period that each revolution gives: the interval that ends at its edge
/// of the channel that sets the clock, or what the spacecraft said.

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "pipelines/spin/association/clock_start.h"
#include "pipelines/spin/association/spin_period_window.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

class PeriodIntervals {
 public:
  /// @param edge_sigma_s One standard deviation of an edge's time.
  PeriodIntervals(const SpinScreening& screening, double edge_sigma_s)
      : screening_{screening}, window_{screening, edge_sigma_s} {}

  /// Starts anew after a change of channel or rate, which no interval may span.
  void begin_anew(double edge_sigma_s);

  /// Keeps a period that the spacecraft stated.
  void note(const PeriodNote& note);
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
