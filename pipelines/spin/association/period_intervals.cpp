#include "pipelines/spin/association/period_intervals.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "pipelines/time/time_span.h"

namespace spindrift {

SpinPeriodWindow::SpinPeriodWindow(const SpinScreening& screening, double edge_sigma_s)
    : screening_{screening},
      candidate_sigma_s_{std::numbers::sqrt2 * edge_sigma_s},
      differences_s_{static_cast<std::size_t>(screening.window)} {}

PeriodCandidate SpinPeriodWindow::judge(TaiTime from, TaiTime to, std::int64_t turns,
                                        double expected_s) {
  assert(turns > 0 && to > from);
  const auto turns_d = static_cast<double>(turns);
  return judge(to, elapsed_s(from, to) / turns_d, turns_d, expected_s);
}

PeriodCandidate SpinPeriodWindow::refused(TaiTime from, TaiTime to, std::int64_t turns,
                                          Rejection rejected_by) const {
  const auto turns_d = static_cast<double>(turns);
  return {.period_s = elapsed_s(from, to) / turns_d,
          .sigma_s = candidate_sigma_s_ / turns_d,
          .rejected_by = rejected_by};
}

PeriodCandidate SpinPeriodWindow::judge(TaiTime t, double period_s, double turns,
                                        double expected_s) {
  const double difference_s = period_s - expected_s;
  differences_s_.add(difference_s);
  const RobustMean mean =
      differences_s_.mean({.sigma = screening_.sigma, .stated = candidate_sigma_s_});
  const double sigma_s = candidate_sigma_s_ / turns;
  const Observation said = Observation::of(t, SampleSource::Period, difference_s - mean.mean,
                                           sigma_s, mean.limit, Rejection::Period);
  return {.period_s = period_s, .sigma_s = sigma_s, .rejected_by = said.rejected_by, .said = said};
}

void PeriodIntervals::begin_anew(double edge_sigma_s) {
  window_ = SpinPeriodWindow{screening_, edge_sigma_s};
  start_.reset();
}

void PeriodIntervals::keep(const PeriodNote& note) {
  notes_.push_back(note);
  if (notes_.size() > 16) {
    notes_.pop_front();
  }
}

void PeriodIntervals::forget_notes_before(TaiTime t) {
  notes_.erase(std::remove_if(notes_.begin(), notes_.end(),
                              [&](const PeriodNote& note) { return note.t_sun1 < t; }),
               notes_.end());
}

std::optional<PeriodCandidate> PeriodIntervals::candidate(
    const Revolution& revolution, PulseChannel reference,
    const std::function<double(TaiTime)>& expected_s) {
  const std::optional<TaiTime>& edge = revolution.edge(reference);
  if (!edge) {
    return std::nullopt;
  }
  const auto& rejected_by = revolution.edge_rejections.at(index_of(reference));
  if (!start_) {
    const auto candidate = noted(revolution, expected_s);
    if (!rejected_by) {
      start_ = {.t = *edge, .revolution = revolution.number};
    }
    return candidate;
  }
  const std::int64_t turns = revolution.number - start_->revolution;
  const TaiTime middle = start_->t + (*edge - start_->t) / 2;
  PeriodCandidate candidate = rejected_by
                                  ? window_.refused(start_->t, *edge, turns, *rejected_by)
                                  : window_.judge(start_->t, *edge, turns, expected_s(middle));
  candidate.sigma_s =
      std::hypot(candidate.sigma_s, apparent_motion_s(reference, candidate.period_s));
  // After this many turns of refused intervals the edge that they start from is doubtful.
  if (!candidate.rejected_by || (!rejected_by && turns >= 5)) {
    start_ = {.t = *edge, .revolution = revolution.number};
  }
  return candidate;
}

/// Returns the period that the spacecraft stated, where no interval ends at this revolution's sun1.
std::optional<PeriodCandidate> PeriodIntervals::noted(
    const Revolution& revolution, const std::function<double(TaiTime)>& expected_s) {
  const std::optional<TaiTime>& sun1 = revolution.edge(PulseChannel::Sun1);
  const auto note = std::find_if(notes_.begin(), notes_.end(),
                                 [&](const PeriodNote& n) { return sun1 && n.t_sun1 == *sun1; });
  if (note == notes_.end() || !(note->period_s > 0.0)) {
    return std::nullopt;
  }
  return window_.judge(*sun1, note->period_s, expected_s(*sun1));
}

}  // namespace spindrift
