#include "pipelines/spin/association/spin_period_window.h"

#include <cassert>
#include <numbers>

#include "pipelines/time/time_span.h"

namespace spindrift {

SpinPeriodWindow::SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s)
    : screening_{screening},
      candidate_sigma_s_{std::numbers::sqrt2 * edge_sigma_s},
      differences_s_{static_cast<std::size_t>(screening.window)} {}

PeriodCandidate SpinPeriodWindow::add(TaiTime from, TaiTime to, std::int64_t turns,
                                      double expected_s) {
  assert(turns > 0 && to > from);
  const auto turns_d = static_cast<double>(turns);
  return add(elapsed_s(from, to) / turns_d, turns_d, expected_s);
}

PeriodCandidate SpinPeriodWindow::refused(TaiTime from, TaiTime to, std::int64_t turns,
                                          Rejection rejected_by) const {
  const auto turns_d = static_cast<double>(turns);
  return {.period_s = elapsed_s(from, to) / turns_d,
          .sigma_s = candidate_sigma_s_ / turns_d,
          .rejected_by = rejected_by};
}

PeriodCandidate SpinPeriodWindow::add(double period_s, double turns, double expected_s) {
  const double difference_s = period_s - expected_s;
  differences_s_.add(difference_s);
  const RobustMean mean =
      differences_s_.mean({.sigma = screening_.sigma, .stated = candidate_sigma_s_});
  return {.period_s = period_s,
          .sigma_s = candidate_sigma_s_ / turns,
          .rejected_by = mean.keeps(difference_s) ? std::nullopt : std::optional{Rejection::Period},
          .test = Rational{.expected = expected_s + mean.mean, .limit = mean.limit}};
}

}  // namespace spindrift
