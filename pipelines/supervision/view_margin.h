/// @file
/// How far inside its field of view a sensor must have a thing before it is expected to see it.

#pragma once

#include "pipelines/frames/angle.h"

namespace spindrift {

/// @param sigma_rad One standard deviation of the attitude or the spin axis.
constexpr double view_margin_rad(double sigma_rad) { return 1.0 * kRadPerDeg + 3.0 * sigma_rad; }

}  // namespace spindrift
