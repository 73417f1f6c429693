/// @file
/// How fast bodies turn that are stabilised by their spin, and how their rate drifts.

#pragma once

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// 1 / (60 s): turns a minute.
inline constexpr double kSlowestSpin_rpm = 5.0;
inline constexpr double kFastestSpin_rpm = 200.0;
/// A fifth beyond, where the period is looked for.
inline constexpr double kSlowestSearched_rpm = 0.8 * kSlowestSpin_rpm;
inline constexpr double kFastestSearched_rpm = 1.2 * kFastestSpin_rpm;
/// No interval that is measured on board is longer: far slower than what is stabilised by its spin.
inline constexpr double kLongestPeriod_s = 60.0;
/// Nor is a period shorter.
inline constexpr double kShortestPeriod_s = 0.1;

/// Of the spin rate in turns a second, in a second.
constexpr double drift_per_s2(double drift_rpm_h) { return drift_rpm_h / 60.0 / kHour_s; }

/// One sigma of a drift of which nothing is known: eddy currents, warming and leaks do less.
inline constexpr double kFirstDrift_rpm_h = 2.0;
/// What is looked for in the edges, at most.
inline constexpr double kMostDrift_rpm_h = 3.0;

}  // namespace spindrift
