/// @file
/// A second attitude beside the one in force, where star fixes contradict that: either the tracker
/// is wrong or the attitude. Its own fixes cannot tell; Sun and field can.

#pragma once

#include "pipelines/three_axis/mekf.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct RivalAttitude {
  /// So many samples do not agree by accident.
  static constexpr int kEnough = 3;

  Mekf filter;
  TaiTime since;
  /// It was in force before star fixes overruled it; else they fit this one.
  bool was_in_force = false;
  /// Star fixes have spoken for it, be it earlier.
  bool has_fixes = true;
  /// That fit this one and not the one in force.
  int star_fixes = 0;
  /// Samples of other sensors that fit the one in force and not this one, less those that do the
  /// opposite.
  int against = 0;

  /// Whether it is more than an outlier.
  bool stands() const { return was_in_force || star_fixes >= kEnough; }
  bool is_refuted() const { return against >= kEnough; }
  bool is_proven() const { return against <= -kEnough; }
};

}  // namespace spindrift
