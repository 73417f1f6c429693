/// @file
/// Limits of the iterated Kalman update of directions, a Gauss-Newton iteration.

#pragma once

namespace spindrift {

/// A larger correction (0.06 deg) is linearised again at its result.
inline constexpr double kFarFromLinear_rad = 1e-3;
/// Largest number of linearisations.
inline constexpr int kMostLinearisations = 8;

}  // namespace spindrift
