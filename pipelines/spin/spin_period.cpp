#include "pipelines/spin/spin_period.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "pipelines/spin/time_span.h"

namespace spindrift {
namespace {

// Few intervals show a trend that is this far beyond their noise.
constexpr double kTrend_sigma = 3.0;

/// Successive intervals together.
struct Span {
  double elapsed_s = 0.0;
  double turns = 0.0;

  void add(double period_s, double more_turns) {
    elapsed_s += period_s * more_turns;
    turns += more_turns;
  }
  double mean_s() const { return elapsed_s / turns; }
};

}  // namespace

SpinPeriodWindow::SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s)
    : screening_{screening},
      edge_sigma_s_{edge_sigma_s},
      periods_s_{static_cast<std::size_t>(screening.window)} {}

PeriodCandidate SpinPeriodWindow::add(TaiTime from, TaiTime to, std::int64_t turns) {
  assert(turns > 0 && to > from);
  const auto turns_d = static_cast<double>(turns);
  return add(elapsed_s(from, to) / turns_d, turns_d);
}

PeriodCandidate SpinPeriodWindow::refused(TaiTime from, TaiTime to, std::int64_t turns) const {
  const auto turns_d = static_cast<double>(turns);
  return {.period_s = elapsed_s(from, to) / turns_d,
          .sigma_s = std::numbers::sqrt2 * edge_sigma_s_ / turns_d,
          .accepted = false};
}

PeriodCandidate SpinPeriodWindow::add(double period_s, double turns) {
  const double candidate_sigma_s = std::numbers::sqrt2 * edge_sigma_s_;
  periods_s_.add(period_s);
  const RobustMean mean = periods_s_.mean({.sigma = screening_.sigma, .stated = candidate_sigma_s});
  const bool accepted = mean.keeps(period_s);
  entries_.push_back({.period_s = period_s, .turns = turns, .accepted = accepted});
  if (entries_.size() > periods_s_.size()) {
    entries_.pop_front();
  }

  if (auto now = period_now(std::max(mean.sigma, candidate_sigma_s) / std::numbers::sqrt2)) {
    period_ = now;
  }
  return {.period_s = period_s, .sigma_s = candidate_sigma_s / turns, .accepted = accepted};
}

/// @param edge_sigma_s Of one edge's time, as stated or as seen.
std::optional<SpinPeriod> SpinPeriodWindow::period_now(double edge_sigma_s) const {
  Span all;
  std::size_t accepted = 0;
  for (const Entry& entry : entries_) {
    if (entry.accepted) {
      all.add(entry.period_s, entry.turns);
      ++accepted;
    }
  }
  if (accepted == 0) {
    return std::nullopt;
  }
  Span older;
  Span newer;
  for (const Entry& entry : entries_) {
    if (entry.accepted) {
      (2.0 * older.turns < all.turns ? older : newer).add(entry.period_s, entry.turns);
    }
  }
  if (!(newer.turns > 0.0)) {
    newer = older;  // One long silence at the end outweighs all before it: no trend to be seen.
  }
  const double trend_s = newer.mean_s() - older.mean_s();
  const double trend_sigma_s = edge_sigma_s * std::hypot(1.0 / older.turns, 1.0 / newer.turns,
                                                         1.0 / older.turns + 1.0 / newer.turns);
  if (accepted < kTrendIntervals && std::abs(trend_s) <= kTrend_sigma * trend_sigma_s) {
    return SpinPeriod{.period_s = all.mean_s(),
                      .sigma_s = std::numbers::sqrt2 * edge_sigma_s / all.turns};
  }
  const double carried = newer.turns / (older.turns + newer.turns);
  // The three edges that are left: the first, the one between the halves, the last.
  const double first = carried / older.turns;
  const double last = (1.0 + carried) / newer.turns;
  return SpinPeriod{.period_s = newer.mean_s() + carried * trend_s,
                    .sigma_s = edge_sigma_s * std::hypot(first, last, first + last)};
}

}  // namespace spindrift
