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
  /// Time within which a sensor that supports the attitude in force decides against this one.
  static constexpr double kDecided_s = 30.0;

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

  /// Weighs a star fix. @return False if the attitude is to be dropped: star fixes formed it, and
  /// the fix fits the attitude in force, or neither while this one is not refuted.
  bool hear(const ObservedAttitude& fix, bool fits, bool fits_in_force);
  /// Weighs a direction. @return False if the attitude is to be dropped: it was once in force and
  /// is refuted.
  bool hear(const SeenDirection& seen, bool fits, bool fits_in_force);

  /// Returns whether this attitude wins although no other sensor decides.
  /// @param is_confirmed Whether samples besides its first fix support the attitude in force.
  bool overrules(TaiTime t, bool is_confirmed) const;
};

}  // namespace spindrift
