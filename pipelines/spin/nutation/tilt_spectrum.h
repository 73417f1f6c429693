/// @file
/// Spectrum of the tilt, over all edges at once, in cycles a turn.
///
/// With w the residuals times their slopes, D(n) = sum of w exp(-2 pi i n x) is what the residuals
/// say of a tilt that goes round n times in a turn. The six edges of a turn come at phases of their
/// own, so that n and n + 1 differ, which to a sensor that looks once a turn are the same. By one
/// FFT over edges spread onto an even grid, eight points to a turn.

#pragma once

#include "pipelines/spin/nutation/tilt_signal.h"

namespace spindrift {

/// No axisymmetric body nutates faster: its moment of inertia about the axis is at most the sum of
/// the other two.
inline constexpr double kFastestPerTurn = 2.0;

/// Distance from a whole number of times a turn within which a tilt that goes round looks like a
/// slow change.
double unseen_per_turn(const TiltSignal& signal);

/// Where |D| is greatest, to a quarter of what the length of the pass resolves.
/// @param signal Of at least twenty turns in a stretch.
double strongest_per_turn(const TiltSignal& signal);

}  // namespace spindrift
