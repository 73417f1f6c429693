/// @file
/// The Earth as a beam sees it in one revolution: the mission's horizon, sphere or ellipsoid, with
/// the Earth where it has moved to at each edge (by 0.3 deg where a slow body's beams cross it half
/// a turn apart, by 0.07 deg between the two edges of a chord).
///
/// For a given axis, a beam's chord equals that of some sphere at rest. With that sphere's
/// half-angle and the offset of its middle the closed forms of fixes and residuals hold.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sun_earth_directions.h"

namespace spindrift {

struct BeamView {
  double disc_rad;        ///< Half-angle of the sphere at rest.
  double lead_rad = 0.0;  ///< Of the chord's middle, before the Earth's centre at `t_earth`.
  /// Slopes by the axis: for a small step of it, ICRF, each changes by its product with the step.
  /// Zero for the sphere at rest, and left so where the beam has no crossing.
  Eigen::Vector3d disc_per_step_icrf = Eigen::Vector3d::Zero();
  Eigen::Vector3d lead_per_step_icrf = Eigen::Vector3d::Zero();
  /// Empty: the beam misses the Earth or is near-tangent to its limb. The others are then of a beam
  /// nearer to the Earth's centre, which has the chord that was measured.
  std::optional<double> chord_rad = {};
};

/// By Side.
using BeamViews = std::array<BeamView, 2>;

/// The spherical Earth at rest.
BeamViews views_of_sphere(const SunEarthDirections& sun_earth);

/// @param axis_icrf Unit. Where a beam has no crossing, the sphere at rest is all it has.
BeamViews views_of_horizon(const SpinConfig& config, const RevolutionMeasurements& measured,
                           const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf);

/// Of the beam, or the mean of the beams, that an azimuth rests on.
/// @param noise_rad Of the azimuth.
double lead_rad(const BeamViews& beams, const EdgeNoise& noise_rad);

}  // namespace spindrift
