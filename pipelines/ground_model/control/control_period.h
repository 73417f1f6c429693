/// @file
/// Control periods that are too long for the loop that they close.

#pragma once

#include "pipelines/core/expected.h"

namespace spindrift {

/// Natural frequency times period. Torque that is held and comes a period late then takes 26 deg of
/// the 64 deg of phase margin that a loop damped by 0.67 has.
inline constexpr double kMostOfPeriod_rad = 0.2;

/// @return InvalidConfiguration where the period is not positive, or longer than the loop bears.
Expected<void> check_control_period(double period_s, double frequency_rad_s);

}  // namespace spindrift
