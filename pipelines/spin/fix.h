/// @file
/// Spin axis from one revolution alone: cases 1 to 3 of spin.md, with the Delta rules.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>

#include "pipelines/core/expected.h"
#include "pipelines/spin/association.h"
#include "pipelines/spin/config.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/products.h"
#include "pipelines/spin/sightlines.h"

namespace spindrift {

struct AxisSolution {
  int geometry_case;
  Eigen::Vector3d axis_icrf;                           ///< Unit.
  std::optional<Eigen::Vector3d> alternate_axis_icrf;  ///< Unit; the other root.
  Resolution resolution;
  double norm;  ///< Length of the axis before normalising.
  /// What the measurements leave over when the axis is found: norm - 1, and in case 1 the
  /// half-angle of the disc that the chords show, minus rho (rad). Zero but for noise and errors of
  /// the model.
  Eigen::Vector2d contradiction;
};

/// Case 1: sun angle, both chords, dihedral (mean of the two, where both are there). Beams mounted
/// alike are one beam: then case 2.
/// Case 2, 3: sun angle, north or south chord, dihedral; linear where |Delta| is usable, else the
/// better of two roots, AMBIGUOUS where they cannot be told apart.
/// @return Unobservable when a measurement is missing, Sun and Earth stand within 3 deg of one
///         line, or no earth angle fits.
Expected<AxisSolution> solve_axis(const SpinConfig& config, const RevolutionMeasurements& measured,
                                  const Sightlines& sightlines);

/// The solution with its covariance: the stated noise of each edge, carried through measurement
/// and geometry by central differences one sigma wide, so that what shares an edge is correlated.
/// Not accepted when AMBIGUOUS, or when the contradiction exceeds five of its sigmas and half a
/// degree, which is more than the Earth's shape and the height of its CO2 account for.
/// @param left_out Quantities that failed their test.
Expected<SpinFix> fix(const SpinConfig& config, const Revolution& revolution,
                      const std::set<SpinQuantity>& left_out, const Sightlines& sightlines);

}  // namespace spindrift
