/// @file
/// The spin axes that one revolution alone allows: cases 1 to 7 of pipelines/spin/fix/README.md,
/// with the rules of Delta.
///
/// Every angle carries its derivatives with respect to the error sources, so that each candidate
/// has a covariance and angles that share an edge are correlated. The moving Earth has the
/// mission's horizon model.

#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "pipelines/core/no_fix.h"
#include "pipelines/spin/fix/axis_angles.h"
#include "pipelines/spin/fix/fix_input.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

struct AxisCandidate {
  Eigen::Vector3d axis_icrf;        ///< Unit vector.
  Eigen::Matrix2d covariance_rad2;  ///< From edge noise, tangent plane: east, north.
  /// Covariance that errors of the mission file add, in the same plane.
  Eigen::Matrix2d alignment_rad2 = Eigen::Matrix2d::Zero();
  double norm;  ///< Length of the axis before normalising.
  /// True when the measurements agree: norm - 1 and, with both chords, the half-angle of the disc
  /// minus rho are within five of their total sigmas plus half a degree, which is more than the
  /// Earth's shape and the height of its CO2 account for.
  bool consistent;
  /// Chi-square, by noise and alignment, of norm - 1 and of the disc that both chords show.
  double misfit = 0.0;
  /// Motion of the axis per model error, rad/rad, ICRF.
  Eigen::Matrix<double, 3, kModelErrors> model_shift_icrf;
  /// True axis minus this one per error of the mission file, each as independent ones of unit
  /// variance (root_of()), rad, ICRF.
  Eigen::Matrix<double, 3, kSpinAlignmentErrors> alignment_shift_icrf =
      Eigen::Matrix<double, 3, kSpinAlignmentErrors>::Zero();

  Eigen::Matrix2d total_covariance_rad2() const { return covariance_rad2 + alignment_rad2; }
};

struct AxisCandidates {
  int geometry_case;
  std::vector<AxisCandidate> candidates;  ///< Best first, never empty.
  bool told_apart;  ///< True when geometry alone shows that the first is true.
  /// True when within noise and model the cones touch rather than cross. The candidates then hardly
  /// differ, are not linear in the noise, and have too small covariances.
  bool near_tangent;
};

struct NoCandidates {
  WhyNoFix why;
  /// True when no axis explains the measurements within their noise; else they leave the axis open.
  bool contradictory = false;
};

using FoundCandidates = tl::expected<AxisCandidates, NoCandidates>;

/// Returns the case (1 to 10) of pipelines/spin/fix/README.md that the measurements form; 0: none.
int geometry_case_of(const RevolutionMeasurements& measured);

/// Solves the axis from the good measurements. With the dihedral (the mean if there are two), case
/// 1 uses both chords, cases 2 and 3 are linear where |Delta| is usable and have two roots
/// otherwise. Without a dihedral the cones about Sun and Earth meet in two axes. Cases 4 to 7 solve
/// theta_s from the angle between Sun and Earth. Beams whose mounting angles coincide count as one.
/// @return NoCandidates for a cone (cases 8 to 10), Sun and Earth within 3 deg of one line, and
/// measurements that no axis explains.
FoundCandidates axis_candidates(const SpinConfig& config, const RevolutionMeasurements& measured,
                                const SunEarthDirections& sun_earth);

/// Solves each root on the sphere at rest again with the beams' views of the horizon, until it
/// converges. The horizon moves a root by about a degree and changes little over that; a root near
/// another one may move more. Roots that vanish are dropped and the rest is ranked (see rank()).
/// @param on_sphere Input made with views_of_sphere().
AxisSolutions solve_on_horizon(const FixInput& on_sphere);

/// Returns whether the measurements suffice for a fix but give no consistent one, which shows that
/// sensors, orbit or edges are not as described.
bool is_inconsistent(const FoundCandidates& found);

}  // namespace spindrift
