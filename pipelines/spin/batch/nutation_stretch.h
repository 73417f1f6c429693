/// @file
/// Models free nutation in a stretch of a pass by four unknowns of the estimator.
///
/// The body, tipped in the frame `spin` by the rotation (e_x, e_y), gives the edges that uniform
/// spin about the tipped axes would give. Dissipation makes the tilt grow exponentially:
///
///     e_x + i e_y = g exp(kappa x + i (n phi + delta x))
///
/// Here phi is the phase of the uniform spin from the middle of the pass, n the nutation cycles per
/// turn of the body, and x the time in the stretch from -1 to 1. The unknowns are g, kappa and
/// delta; n is fixed. A pass in which nutation grows much or changes its frequency has many
/// stretches.

#pragma once

#include <Eigen/Core>

#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr int kNutationUnknowns = 4;
using NutationSlopes = Eigen::Matrix<double, 1, kNutationUnknowns>;

struct NutationStretch {
  TaiTime begin;
  TaiTime end;  ///< End of the stretch, exclusive.
  double per_turn;
  Eigen::Matrix<double, kNutationUnknowns, 1> unknowns;  ///< g (rad), kappa, delta (rad).

  bool holds(TaiTime t) const { return begin <= t && t < end; }
  double half_s() const;
};

/// Holds the tilt at an instant and its slopes.
struct NutationTilt {
  Eigen::Vector2d rotation_rad;
  Eigen::Matrix<double, 2, kNutationUnknowns> per_unknown;
  Eigen::Vector2d per_phase;  ///< Change of the tilt with the phase, rad/rad.
};
NutationTilt tilt_at(const NutationStretch& stretch, TaiTime t, double phase_rad);

}  // namespace spindrift
