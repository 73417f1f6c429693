#include "pipelines/spin/spin_period.h"

#include <algorithm>
#include <cassert>
#include <numbers>

#include "pipelines/spin/time_span.h"

namespace spindrift {

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

  double interval_sum_s = 0.0;
  double turn_sum = 0.0;
  for (const Entry& entry : entries_) {
    if (entry.accepted) {
      interval_sum_s += entry.period_s * entry.turns;
      turn_sum += entry.turns;
    }
  }
  if (turn_sum > 0.0) {
    period_ = SpinPeriod{.period_s = interval_sum_s / turn_sum,
                         .sigma_s = std::max(mean.sigma, candidate_sigma_s) / turn_sum};
  }
  return {.period_s = period_s, .sigma_s = candidate_sigma_s / turns, .accepted = accepted};
}

}  // namespace spindrift
