/// @file
/// Control periods that are too long for the loop that they close.

#pragma once

#include "pipelines/core/expected.h"

namespace spindrift {

/// Natural frequency times period. Holding a torque and telling it a period late takes 16 deg of
/// the phase margin of a loop damped by 0.67 where this is a fifth: a quarter of what there is.
inline constexpr double kMostOfPeriod_rad = 0.2;

/// @return InvalidConfiguration where the period is not positive, or longer than the loop bears.
Expected<void> check_control_period(double period_s, double frequency_rad_s);

}  // namespace spindrift
