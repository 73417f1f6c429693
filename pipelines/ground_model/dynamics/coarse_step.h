/// @file
/// Steps that are too coarse for what they step.

#pragma once

#include "pipelines/core/expected.h"

namespace spindrift {

/// A body that turns by more in a step is not well integrated: of a turn of a tenth of a radian
/// Runge-Kutta loses 5e-8, a degree in three thousand turns.
inline constexpr double kMostTurn_rad = 0.1;

/// @param rate_rad_s The fastest that the body may come to turn.
/// @return InvalidConfiguration where the step is not positive or the body turns by more than
///         kMostTurn_rad in it.
Expected<void> check_step(double step_s, double rate_rad_s);

}  // namespace spindrift
