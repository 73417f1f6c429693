/// @file
/// The spin period from the edges of one channel when nothing is known beforehand.

#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Further from the comb than so many of its noise an edge is spurious: it would spoil the fit.
inline constexpr double kOnComb_sigma = 6.0;

/// A comb of nearly equally spaced instants that most edges lie on.
struct PulseTrain {
  TaiTime t;            ///< One of them, near the first edge that lies on it.
  double period_s;      ///< Their spacing at t.
  double drift_per_s2;  ///< Of their rate, 1/s: 0 unless that explains the edges far better.
  double scatter_s;     ///< Standard deviation of the edges about it, at least the stated one.
  std::size_t edges;    ///< How many edges lie on it.
  double turns;         ///< That they span.
};

/// Tries the intervals between neighbouring edges as the period, counts for each how many edges
/// fall on its comb, and takes the longest period that explains nearly as many as any: half of it
/// explains as many, twice of it half. Where none explains enough and most edges come several times
/// within a twentieth of a turn, those that come first are looked at.
///
/// @param edges In order of time; the last thirty-two are looked at.
/// @param noise_s Standard deviation of an edge that is stated.
/// @param fewest Fewer edges on the comb are no evidence.
/// @return Empty where less than two thirds of the edges, or of the turns, fit any period between
/// those of the slowest and the fastest rate searched.
std::optional<PulseTrain> find_pulse_train(std::span<const TaiTime> edges, double noise_s,
                                           std::size_t fewest);

}  // namespace spindrift
