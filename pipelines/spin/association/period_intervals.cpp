#include "pipelines/spin/association/period_intervals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spindrift {
namespace {

constexpr std::size_t kMostNotes = 16;
// After this many turns of refused intervals the edge that they start from is doubtful.
constexpr std::int64_t kMostTurnsRefused = 5;

}  // namespace

void PeriodIntervals::begin_anew(double edge_sigma_s) {
  window_ = SpinPeriodWindow{screening_, edge_sigma_s};
  start_.reset();
}

void PeriodIntervals::note(const PeriodNote& note) {
  notes_.push_back(note);
  if (notes_.size() > kMostNotes) {
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
                                  : window_.add(start_->t, *edge, turns, expected_s(middle));
  candidate.sigma_s =
      std::hypot(candidate.sigma_s, apparent_motion_s(reference, candidate.period_s));
  if (!candidate.rejected_by || (!rejected_by && turns >= kMostTurnsRefused)) {
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
  return window_.add(note->period_s, expected_s(*sun1));
}

}  // namespace spindrift
