/// @file
/// A second attitude, kept when star fixes contradict the one in force: either the star tracker or
/// the attitude is wrong. Star fixes alone cannot decide which; Sun and magnetic field can.

#pragma once

#include "pipelines/three_axis/mekf.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct RivalAttitude {
  /// Number of samples beyond which an agreement is not accidental.
  static constexpr int kEnough = 3;

  Mekf filter;
  TaiTime since;
  /// True if star fixes overruled this attitude; false if they formed it.
  bool was_in_force = false;
  /// True if star fixes have ever supported this attitude.
  bool has_fixes = true;
  /// Number of star fixes that fit this attitude and not the one in force.
  int star_fixes = 0;
  /// Samples of other sensors that fit only the attitude in force, minus those that fit only this.
  int against = 0;

  /// Returns whether this attitude is more than an outlier.
  bool stands() const { return was_in_force || star_fixes >= kEnough; }
  bool is_refuted() const { return against >= kEnough; }
  bool is_proven() const { return against <= -kEnough; }
};

}  // namespace spindrift
