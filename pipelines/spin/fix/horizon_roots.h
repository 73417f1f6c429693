/// @file
/// Solves a revolution on the mission's horizon, with the Earth moving.

#pragma once

#include "pipelines/spin/fix/axis_angles.h"
#include "pipelines/spin/fix/fix_input.h"

namespace spindrift {

/// Solves each root on the sphere at rest again with the beams' views of the horizon, until it
/// converges. The horizon moves a root by about a degree and changes little over that; a root near
/// another one may move more. Roots that vanish are dropped and the rest is ranked (see rank()).
/// @param on_sphere Input made with views_of_sphere().
AxisSolutions solve_on_horizon(const FixInput& on_sphere);

}  // namespace spindrift
