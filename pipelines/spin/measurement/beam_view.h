/// @file
/// The Earth as a beam sees it in one revolution: the mission's horizon, sphere or ellipsoid, with
/// the Earth at its position at each edge (it moves by 0.3 deg where a slow body's beams cross it
/// half a turn apart, by 0.07 deg between the two edges of a chord).
///
/// For a given axis, a beam's chord equals that of some sphere at rest. With that sphere's
/// half-angle and the offset of its middle the closed forms of fixes and residuals hold.
///
/// Where the beam misses the Earth, the sphere is that of a beam nearer to the Earth's centre with
/// the measured chord. A sphere in which this beam is as deep was rejected: it is off by up to 0.19
/// deg for narrow chords.

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/sky.h"

namespace spindrift {

struct BeamView {
  double disc_rad;        ///< Half-angle of the sphere at rest.
  double lead_rad = 0.0;  ///< Lead of the chord's middle before the Earth's centre at `t_earth`.
  /// Slopes by the axis: for a small step of it in ICRF, each value changes by its product with the
  /// step. Zero for the sphere at rest and for a beam without crossing.
  Eigen::Vector3d disc_per_step_icrf = Eigen::Vector3d::Zero();
  Eigen::Vector3d lead_per_step_icrf = Eigen::Vector3d::Zero();
  /// Empty when the beam misses the Earth or is near-tangent to its limb. The other values are then
  /// those of a beam nearer to the Earth's centre that has the measured chord.
  std::optional<double> chord_rad = {};
};

/// Views by Side.
using BeamViews = std::array<BeamView, 2>;

/// Returns the views of the spherical Earth at rest.
BeamViews views_of_sphere(const SunEarthDirections& sun_earth);

/// @param axis_icrf Unit vector. Where a beam has no crossing, the sphere at rest is used.
BeamViews views_of_horizon(const SpinConfig& config, const RevolutionMeasurements& measured,
                           const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf);

/// Returns the lead of the beam, or the mean of the beams, that an azimuth rests on.
/// @param noise_rad Noise of the azimuth.
double lead_rad(const BeamViews& beams, const EdgeNoise& noise_rad);

}  // namespace spindrift
