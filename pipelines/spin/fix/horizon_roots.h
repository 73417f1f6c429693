/// @file
/// The solutions of a revolution on the mission's horizon, while the Earth moves.

#pragma once

#include "pipelines/spin/fix/axis_angles.h"
#include "pipelines/spin/fix/fix_input.h"

namespace spindrift {

/// Each root on the sphere at rest is solved again with what the beams see from it, until it
/// converges: the horizon moves it by a degree or so, and changes little over that; more where
/// roots come together. A root that vanishes is dropped. The others are ranked: which is the best,
/// and whether it is beyond doubt the true one.
/// @param on_sphere Made with views_of_sphere().
AxisSolutions solve_on_horizon(const FixInput& on_sphere);

}  // namespace spindrift
