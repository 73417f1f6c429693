/// @file
/// The solutions of a revolution on the mission's horizon, while the Earth moves.

#pragma once

#include "pipelines/spin/fix/axis_angles.h"
#include "pipelines/spin/fix/fix_input.h"

namespace spindrift {

/// Each root on the sphere at rest is solved anew with what the beams see from it, until it stands
/// still: the horizon moves it by a degree at most, and changes little over that. A root that then
/// is none is dropped. Which of them is the best, and whether it is the true one, is of those that
/// are left.
/// @param on_sphere Made with views_of_sphere().
AxisSolutions solve_on_horizon(const FixInput& on_sphere);

}  // namespace spindrift
