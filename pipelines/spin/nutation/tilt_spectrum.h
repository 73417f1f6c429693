/// @file
/// Spectrum of the tilt, over all edges at once, in cycles a turn.
///
/// With w the residuals times their slopes, D(n) = sum of w exp(-2 pi i n x) is the spectrum of a
/// tilt at n cycles per turn. The six edges of a turn have different phases, so that n and n + 1
/// differ, which a sensor that looks once a turn cannot tell apart. The spectrum is computed by one
/// FFT over edges spread onto a uniform grid of eight points per turn.

#pragma once

#include "pipelines/spin/nutation/tilt_signal.h"

namespace spindrift {

/// Fastest nutation of an axisymmetric body, whose moment of inertia about the axis is at most the
/// sum of the other two.
inline constexpr double kFastestPerTurn = 2.0;

/// Returns the distance from whole cycles per turn within which a tilt looks like a slow change.
double unseen_per_turn(const TiltSignal& signal);

/// Returns the frequency of the greatest |D|, to a quarter of the pass's resolution.
/// @param signal Signal with at least twenty turns in a stretch.
double strongest_per_turn(const TiltSignal& signal);

}  // namespace spindrift
