/// @file
/// What the beams have of the Earth in one revolution: of the mission's horizon, sphere or
/// ellipsoid, which each edge meets where the Earth has moved to by then (by 0.3 deg where a slow
/// body's beams cross it half a turn apart, by 0.07 deg between the two edges of a chord).
///
/// Seen from one axis, a beam's chord is also that of some sphere at rest. By its half-angle, and
/// by how far its middle is from that of the chord, the closed forms of fixes and residuals hold.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sightlines.h"

namespace spindrift {

struct BeamView {
  double disc_rad;        ///< Half-angle of the sphere at rest.
  double lead_rad = 0.0;  ///< Of the chord's middle, before the Earth's centre at `t_earth`.
  /// Slopes by the axis: for a small step of it, ICRF, each changes by its product with the step.
  /// Zero for the sphere at rest, and left so where the beam has no crossing.
  Eigen::Vector3d disc_per_step_icrf = Eigen::Vector3d::Zero();
  Eigen::Vector3d lead_per_step_icrf = Eigen::Vector3d::Zero();
  /// Empty: the beam misses the limb, or only grazes it. The others are then of a beam nearer to
  /// the Earth's centre, which has the chord that was measured.
  std::optional<double> chord_rad = {};
};

/// By Side.
using BeamViews = std::array<BeamView, 2>;

/// The spherical Earth at rest.
BeamViews views_of_sphere(const Sightlines& sightlines);

/// @param axis_icrf Unit. Where a beam has no crossing, the sphere at rest is all it has.
BeamViews views_of_horizon(const SpinConfig& config, const RevolutionMeasurements& measured,
                           const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf);

/// Of the beam, or the mean of the beams, that an azimuth rests on.
/// @param noise_rad Of the azimuth.
double lead_rad(const BeamViews& beams, const EdgeNoise& noise_rad);

}  // namespace spindrift
