/// @file
/// Free nutation in a stretch of a pass, as four unknowns of the estimator.
///
/// The body, tipped in the frame `spin` by the rotation (e_x, e_y), gives its edges as an even spin
/// about the tipped axes would. While dissipation drives it, the tilt grows evenly in its
/// logarithm:
///
///     e_x + i e_y = g exp(kappa x + i (n phi + delta x))
///
/// with phi the phase of the even spin from the middle of the pass, n times round in a turn of the
/// body, and x the time in the stretch from -1 to 1. Unknowns are g, kappa and delta; n stays.
/// Where nutation grows by much, or its frequency with it, a pass is many stretches.

#pragma once

#include <Eigen/Core>

#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr int kNutationUnknowns = 4;
using NutationSlopes = Eigen::Matrix<double, 1, kNutationUnknowns>;

struct NutationStretch {
  TaiTime begin;
  TaiTime end;  ///< Exclusive.
  double per_turn;
  Eigen::Matrix<double, kNutationUnknowns, 1> unknowns;  ///< g (rad), kappa, delta (rad).

  bool holds(TaiTime t) const { return begin <= t && t < end; }
  double half_s() const;
};

/// The tilt at an instant.
struct NutationTilt {
  Eigen::Vector2d rotation_rad;
  Eigen::Matrix<double, 2, kNutationUnknowns> per_unknown;
  Eigen::Vector2d per_phase;  ///< rad/rad
};
NutationTilt tilt_at(const NutationStretch& stretch, TaiTime t, double phase_rad);

}  // namespace spindrift
