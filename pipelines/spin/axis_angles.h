/// @file
/// The angles of the axis to Sun and Earth that fit the measurements of one revolution: cases 1 to
/// 7 of spin.md, with the Delta rules.

#pragma once

#include <string>
#include <vector>

#include "pipelines/spin/fix_input.h"
#include "pipelines/spin/uncertain.h"

namespace spindrift {

/// An axis by its angles to Sun and Earth and the dihedral between them.
struct AxisAngles {
  Uncertain sun_angle_rad;
  Uncertain earth_angle_rad;
  Uncertain dihedral_rad;
};

/// What was found on the way to a solution.
struct AxisSolutions {
  std::vector<AxisAngles> places;  ///< Best first.
  bool told_apart = true;
  bool grazing = false;
  std::string reason;  ///< Why there is none.
};

/// @param input With a chord, and an azimuth or a sun angle.
AxisSolutions solve_axis_angles(const FixInput& input);

}  // namespace spindrift
