/// @file
/// The spin period from the edges of one channel when nothing is known beforehand, or when the spin
/// rate has made a step.

#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// An edge further from the comb than this many sigmas is spurious and would spoil the fit.
inline constexpr double kOnComb_sigma = 6.0;

/// A comb of nearly equally spaced instants that most edges lie on.
struct PulseTrain {
  TaiTime t;            ///< Instant of the comb near the first edge on it.
  double period_s;      ///< Spacing of the comb at t.
  double drift_per_s2;  ///< Drift of its rate; 0 unless it explains the edges far better.
  double scatter_s;     ///< Standard deviation of the edges about it, at least the stated one.
  std::size_t edges;    ///< How many edges lie on it.
  double turns;         ///< Turns that these edges span.
};

/// Finds the comb of a channel's edges. It tries the intervals between neighbouring edges as the
/// period, counts how many edges fall on the comb of each, and takes the longest that explains
/// nearly as many as any: half of the true period explains as many, twice of it half. Where none
/// explains enough and most edges come several times within a twentieth of a turn, only the first
/// of each are used.
///
/// @param edges In order of time; the last thirty-two are used.
/// @param noise_s Stated standard deviation of an edge.
/// @param fewest Fewer edges on the comb are no evidence.
/// @return Empty where no period within the searched rates has 65 percent of the edges on its comb,
/// and an edge on 45 percent of its turns.
std::optional<PulseTrain> find_pulse_train(std::span<const TaiTime> edges, double noise_s,
                                           std::size_t fewest);

/// Detects a step of the spin rate: the last edges of the channel that sets the clock are equally
/// spaced, but not as the clock expects.
class RateStepDetector {
 public:
  /// @param good Whether the clock expects an edge at `t`.
  void add(TaiTime t, bool good);
  /// Replaces the last edge by a copy of it that came where the clock expects it.
  void replace_last(TaiTime t) {
    if (!recent_.empty()) {
      recent_.back() = {.t = t, .good = true};
    }
  }

  /// Returns the comb of the latest edges if the clock should be set by it: the last edge lies on
  /// it and is not good, and it is not the clock's own comb.
  /// @param noise_s Standard deviation of an edge as observed so far.
  /// @param period_s Period of the clock.
  std::optional<PulseTrain> new_pulse_train(double noise_s, double period_s) const;

  void forget() { recent_.clear(); }

 private:
  struct ReferenceEdge {
    TaiTime t;
    bool good;
  };

  std::deque<ReferenceEdge> recent_;
};

}  // namespace spindrift
