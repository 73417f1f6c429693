/// @file
/// Check that an integration step is fine enough for the rate of the body.

#pragma once

#include "pipelines/core/expected.h"

namespace spindrift {

/// Largest turn in one step: at 0.1 rad Runge-Kutta loses 5e-9 rad, a degree in 50,000 turns.
inline constexpr double kMostTurn_rad = 0.1;

/// @param rate_rad_s Upper bound of the body's rate.
/// @return InvalidConfiguration where the step is not positive or the body turns by more than
///         kMostTurn_rad in it.
Expected<void> check_step(double step_s, double rate_rad_s);

}  // namespace spindrift
