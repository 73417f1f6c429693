/// @file
/// Limits of an iterated Kalman update of directions: Gauss and Newton's iteration of prior and
/// measurement.

#pragma once

namespace spindrift {

/// A correction beyond this (0.06 deg) is linearised anew where it ends.
inline constexpr double kFarFromLinear_rad = 1e-3;
/// Up to so many times.
inline constexpr int kMostLinearisations = 8;

}  // namespace spindrift
