#include "pipelines/spin/spin_period.h"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <vector>

#include "pipelines/spin/robust_mean.h"

namespace spindrift {

SpinPeriodWindow::SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s)
    : screening_{screening}, edge_sigma_s_{edge_sigma_s} {}

PeriodCandidate SpinPeriodWindow::add(TaiTime from, TaiTime to, std::int64_t turns) {
  assert(turns > 0 && to > from);
  const auto turns_d = static_cast<double>(turns);
  const double candidate_sigma_s = std::numbers::sqrt2 * edge_sigma_s_;
  entries_.push_back(
      {.period_s = seconds_between(from, to) / turns_d, .turns = turns_d, .accepted = false});
  if (entries_.size() > static_cast<std::size_t>(screening_.window)) {
    entries_.pop_front();
  }

  std::vector<double> periods_s(entries_.size());
  std::transform(entries_.begin(), entries_.end(), periods_s.begin(),
                 [](const Entry& e) { return e.period_s; });
  const RobustMean mean =
      robust_mean(periods_s, {.sigma = screening_.sigma, .stated = candidate_sigma_s});
  Entry& entry = entries_.back();
  entry.accepted = mean.keeps(entry.period_s);

  double interval_sum_s = 0.0;
  double turn_sum = 0.0;
  for (const Entry& e : entries_) {
    if (e.accepted) {
      interval_sum_s += e.period_s * e.turns;
      turn_sum += e.turns;
    }
  }
  if (turn_sum > 0.0) {
    period_ = SpinPeriod{.period_s = interval_sum_s / turn_sum,
                         .sigma_s = std::max(mean.sigma, candidate_sigma_s) / turn_sum};
  }
  return {.period_s = entry.period_s,
          .sigma_s = candidate_sigma_s / turns_d,
          .accepted = entry.accepted};
}

}  // namespace spindrift
