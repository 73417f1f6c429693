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

/// An axis by its angles to Sun and Earth and the dihedral between them.
struct AxisAngles {
  Uncertain sun_angle_rad;
  Uncertain earth_angle_rad;
  Uncertain dihedral_rad;
  BeamViews beams = {};  ///< That it was solved with.
};

/// What was found on the way to a solution.
struct AxisSolutions {
  std::vector<AxisAngles> places;
  bool told_apart = false;  ///< Only rank() knows.
  bool near_tangent = false;
  std::optional<WhyNoFix> reason = {};  ///< Why there is none.
};

/// With what the beams of `input` are said to see.
/// @param input With a chord, and an azimuth or a sun angle.
AxisSolutions solve_axis_angles(const FixInput& input);

/// Best first, and whether the first is beyond doubt the true one.
void rank(const FixInput& input, AxisSolutions& found);

}  // namespace spindrift
