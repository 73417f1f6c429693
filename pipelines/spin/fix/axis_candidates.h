/// @file
/// The spin axes that one revolution alone allows: cases 1 to 7 of
/// pipelines/spin/fix/README.md, with the rules of Delta.
///
/// Every angle is solved together with its derivatives to the sources of error, so that each
/// candidate has its covariance, and what shares an edge is correlated. The Earth is the mission's,
/// moving, with its horizon.

#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "pipelines/core/no_fix.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/sun_earth_directions.h"

namespace spindrift {

struct AxisCandidate {
  Eigen::Vector3d axis_icrf;        ///< Unit.
  Eigen::Matrix2d covariance_rad2;  ///< From the edges' noise. Tangent plane: east, north.
  double norm;                      ///< Length of the axis before normalising.
  /// The measurements agree: norm - 1 and, with both chords, the half-angle of the disc that they
  /// show minus rho are within five of their sigmas and half a degree, which is more than the
  /// Earth's shape and the height of its CO2 account for.
  bool consistent;
  /// Chi-square of what the measurements have too much: of norm - 1, and of the disc that both
  /// chords show, by the edges' noise alone.
  double misfit = 0.0;
  /// What each error of the model moves the axis by, for every radian of it; in ICRF.
  Eigen::Matrix<double, 3, kModelErrors> model_shift_icrf;
};

struct AxisCandidates {
  int geometry_case;
  std::vector<AxisCandidate> candidates;  ///< Best first, never empty.
  bool told_apart;  ///< The geometry alone shows that the first is the true one.
  /// Near-tangent: within noise and model the cones touch rather than cross. The candidates hardly
  /// differ, are not linear in the noise, and their covariances are too small.
  bool near_tangent;
};

struct NoCandidates {
  WhyNoFix why;
  /// Beyond their noise, no axis explains the measurements. Otherwise they only leave it open.
  bool contradictory = false;
};

using FoundCandidates = tl::expected<AxisCandidates, NoCandidates>;

/// Which of the ten cases of pipelines/spin/fix/README.md the good measurements are; 0: none.
int geometry_case_of(const RevolutionMeasurements& measured);

/// From the good measurements. With the dihedral (the mean of the two, where both are there):
/// case 1 by both chords; 2, 3 linear where |Delta| is usable, else by two roots; without it the
/// two axes in which the cones about Sun and Earth meet. Cases 4 to 7 solve theta_s from the angle
/// between Sun and Earth. Beams whose mounting angles coincide count as one.
/// @return None for a cone (cases 8 to 10), Sun and Earth within 3 deg of one line, and
///         measurements that no axis explains.
FoundCandidates axis_candidates(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const SunEarthDirections& sun_earth);

/// The measurements have enough in them for a fix, but no consistent one: sensors, orbit or edges
/// are not what they are said to be.
bool is_inconsistent(const FoundCandidates& found);

}  // namespace spindrift
