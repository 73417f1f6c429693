/// @file
/// Spin period from successive edges of one channel, and its rationality test.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "pipelines/spin/config.h"
#include "pipelines/spin/robust_mean.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// One interval between edges `turns` revolutions apart, divided by them.
struct PeriodCandidate {
  double period_s;
  double sigma_s;  ///< From the stated pulse noise.
  bool accepted;
};

struct SpinPeriod {
  double period_s;
  double sigma_s;
};

/// Sliding window of period candidates: one alone is unreliable.
///
/// Rejected candidates stay in the window: when the rate really changes they become the majority,
/// and the test follows.
class SpinPeriodWindow {
 public:
  /// @param edge_sigma_s One standard deviation of an edge's time.
  SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s);

  /// Tests the interval `from` -> `to`, `turns` > 0 revolutions long, and adds it.
  PeriodCandidate add(TaiTime from, TaiTime to, std::int64_t turns);
  /// The same for one turn timed elsewhere.
  PeriodCandidate add(double period_s) { return add(period_s, 1.0); }
  /// An interval that ends at an edge known to be wrong: it is not added.
  PeriodCandidate refused(TaiTime from, TaiTime to, std::int64_t turns) const;

  /// At the end of the window: the mean of its intervals, carried on by the difference of its
  /// halves, since a rate that drifts would leave the mean behind and the axis with it. The
  /// accepted intervals follow one another from edge to edge, so that the noise of the edges
  /// between cancels: what was accepted is not judged again. Below kTrendIntervals the mean alone,
  /// unless the halves differ by more than their noise.
  /// Empty before the first candidate accepted.
  std::optional<SpinPeriod> period() const { return period_; }
  std::size_t size() const { return entries_.size(); }

  static constexpr std::size_t kTrendIntervals = 20;

 private:
  struct Entry {
    double period_s;
    double turns;
    bool accepted;
  };

  PeriodCandidate add(double period_s, double turns);
  std::optional<SpinPeriod> period_now(double edge_sigma_s) const;

  SpinScreening screening_;
  double edge_sigma_s_;
  std::deque<Entry> entries_;
  SlidingRobustMean periods_s_;
  std::optional<SpinPeriod> period_;
};

}  // namespace spindrift
