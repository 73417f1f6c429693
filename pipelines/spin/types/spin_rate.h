/// @file
/// Range of the spin rates of spin-stabilised satellites and of their drift; the spin period, and
/// one measured interval as a candidate for it.

#pragma once

#include <optional>

#include "pipelines/observation/observation.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Spin rates in rpm: turns a minute, 1 / (60 s).
inline constexpr double kSlowestSpin_rpm = 5.0;
inline constexpr double kFastestSpin_rpm = 200.0;
/// Spin rates between which the period is searched, a fifth beyond either end.
inline constexpr double kSlowestSearched_rpm = 0.8 * kSlowestSpin_rpm;
inline constexpr double kFastestSearched_rpm = 1.2 * kFastestSpin_rpm;
/// No interval measured on board is longer: that is far slower than any spin-stabilised body.
inline constexpr double kLongestPeriod_s = 60.0;
/// No period measured on board is shorter.
inline constexpr double kShortestPeriod_s = 0.1;

/// Converts a drift of the spin rate from rpm an hour to turns/s^2.
constexpr double drift_per_s2(double drift_rpm_h) { return drift_rpm_h / 60.0 / kHour_s; }

/// One sigma of an unknown drift: eddy currents, warming and leaks cause less.
inline constexpr double kFirstDrift_rpm_h = 2.0;
/// Largest drift that is searched for in the edges.
inline constexpr double kMostDrift_rpm_h = 3.0;

/// One interval between two edges, divided by the number of revolutions between them.
struct PeriodCandidate {
  double period_s;
  double sigma_s;  ///< One sigma from the stated pulse noise.
  /// Rejection by its test, or with the edge that it ends at; empty: accepted.
  std::optional<Rejection> rejected_by;
  /// What it said against the other intervals; empty: it was rejected with its edge.
  std::optional<Observation> said = {};
};

struct SpinPeriod {
  double period_s;
  double sigma_s;
  double drift_per_s2 = 0.0;  ///< Drift of the spin rate in turns a second.
};

}  // namespace spindrift
