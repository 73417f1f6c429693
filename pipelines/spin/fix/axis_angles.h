/// @file
/// The angles of the axis to Sun and Earth that fit the measurements of one revolution: cases 1 to
/// 7 of pipelines/spin/fix/README.md, with the rules of Delta.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/core/no_fix.h"
#include "pipelines/spin/fix/fix_input.h"
#include "pipelines/spin/measurement/uncertain.h"

namespace spindrift {

/// Holds an axis by its angles to Sun and Earth and the dihedral between them.
struct AxisAngles {
  Uncertain sun_angle_rad;
  Uncertain earth_angle_rad;
  Uncertain dihedral_rad;
  BeamViews beams = {};  ///< Beam views of the solution.
};

/// Holds the roots found and their state.
struct AxisSolutions {
  std::vector<AxisAngles> places;
  bool told_apart = false;  ///< Set by rank().
  bool near_tangent = false;
  std::optional<WhyNoFix> reason = {};  ///< Reason for having no root.
};

/// Solves the angles with the beam views of `input`.
/// @param input Measurements with a chord, and an azimuth or a sun angle.
AxisSolutions solve_axis_angles(const FixInput& input);

/// Sorts the roots, best first, and tests whether the first is surely the true one.
void rank(const FixInput& input, AxisSolutions& found);

}  // namespace spindrift
