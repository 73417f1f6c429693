#include "pipelines/spin/earth_motion.h"

#include <cmath>
#include <optional>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"

namespace spindrift {
namespace {

Sightlines at_time(const Sightlines& sightlines, TaiTime t) {
  const Eigen::Vector3d earth_icrf =
      sightlines.earth_icrf +
      seconds_between(sightlines.t_earth, t) * sightlines.earth_motion_icrf_s;
  Sightlines there = sightlines;
  there.earth_icrf = earth_icrf.normalized();
  there.disc_rad = std::asin(std::sin(sightlines.disc_rad) / earth_icrf.norm());
  return there;
}

/// Where a beam meets the Earth: azimuths behind the Sun.
struct Limbs {
  double in_rad;
  double out_rad;
};

/// On the sphere: its shape hardly changes what the motion does.
std::optional<Limbs> limbs_of(const InfraredSensor& beam, const Sightlines& sightlines,
                              const Eigen::Vector3d& axis_icrf) {
  const PredictedAngles angles =
      predict_angles(axis_icrf, sightlines.sun_icrf, sightlines.earth_icrf);
  const auto chord_rad =
      predict_chord_rad(beam.mount_angle_rad, angles.earth_angle_rad, sightlines.disc_rad);
  if (!chord_rad) {
    return std::nullopt;
  }
  return Limbs{.in_rad = angles.dihedral_rad - 0.5 * *chord_rad,
               .out_rad = angles.dihedral_rad + 0.5 * *chord_rad};
}

}  // namespace

EdgeNoise late_by_earth_motion(const SpinConfig& config, const RevolutionMeasurements& measured,
                               const Sightlines& sightlines, const Eigen::Vector3d& axis_icrf) {
  EdgeNoise late = EdgeNoise::Zero();
  if (sightlines.earth_motion_icrf_s.isZero()) {
    return late;
  }
  for (const Side side : kSides) {
    const auto& beam = sensor_of(config, side);
    const auto& crossing = measured.crossing(side);
    if (!beam || !crossing) {
      continue;
    }
    const auto at_rest = limbs_of(*beam, sightlines, axis_icrf);
    const auto at_in = limbs_of(*beam, at_time(sightlines, crossing->t_in), axis_icrf);
    const auto at_out = limbs_of(*beam, at_time(sightlines, crossing->t_out), axis_icrf);
    if (at_rest && at_in && at_out) {
      const auto in = static_cast<Eigen::Index>(kInChannels.at(index_of(side)));
      const auto out = static_cast<Eigen::Index>(kOutChannels.at(index_of(side)));
      late(in) = wrapped_rad(at_in->in_rad - at_rest->in_rad) / -crossing->chord->noise_rad(in);
      late(out) = wrapped_rad(at_out->out_rad - at_rest->out_rad) / crossing->chord->noise_rad(out);
    }
  }
  return late;
}

}  // namespace spindrift
