#include "pipelines/spin/measurement/beam_view.h"

#include <Eigen/Core>
#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/sensor_model/horizon.h"

namespace spindrift {
namespace {

/// Models the mission's Earth as seen about one axis.
class Earth {
 public:
  Earth(const Horizon& horizon, const SunEarthDirections& sun_earth,
        const Eigen::Vector3d& axis_icrf)
      : axes_{horizon_axes(horizon)}, sightlines_{sun_earth}, axis_icrf_{axis_icrf} {
    R_icrf_spin_ << tangent_basis(axis_icrf), axis_icrf;
  }

  BeamView seen_by(double mount_angle_rad, const EarthCrossing& crossing) const {
    if (const auto view = crossed_by(mount_angle_rad, crossing)) {
      return *view;
    }
    return beside(mount_angle_rad, crossing);
  }

 private:
  double range_km() const { return axes_.equatorial_km / std::sin(sightlines_.disc_rad); }
  double earth_angle_rad() const { return angle_between_rad(axis_icrf_, sightlines_.earth_icrf); }

  EarthView at(TaiTime t) const {
    const Eigen::Vector3d earth_icrf =
        sightlines_.earth_icrf +
        seconds_between(sightlines_.t_earth, t) * sightlines_.earth_motion_icrf_s;
    return {.spacecraft_spin_km = -range_km() * (R_icrf_spin_.transpose() * earth_icrf),
            .pole_spin = R_icrf_spin_.transpose() * sightlines_.earth_pole_icrf};
  }

  /// Returns empty when the beam misses the Earth, or is near-tangent to its limb.
  std::optional<BeamView> crossed_by(double mount_angle_rad, const EarthCrossing& crossing) const {
    const auto in = limb_crossing(axes_, at(crossing.t_in), mount_angle_rad, Crossing::In);
    const auto out = limb_crossing(axes_, at(crossing.t_out), mount_angle_rad, Crossing::Out);
    if (!in || !out) {
      return std::nullopt;
    }
    const Eigen::Vector3d centre_spin = R_icrf_spin_.transpose() * sightlines_.earth_icrf;
    const double centre_rad = std::atan2(centre_spin.y(), centre_spin.x());
    const double before_rad = wrapped_rad(centre_rad - in->azimuth_rad);
    const double behind_rad = wrapped_rad(out->azimuth_rad - centre_rad);
    const Chord chord{.mount_angle_rad = mount_angle_rad, .chord_rad = before_rad + behind_rad};
    const double disc_rad = std::acos(cos_disc_seen(chord, earth_angle_rad()));
    // Slopes by rotations of the frame: azimuths of the chord's ends and of the Earth's centre.
    const Eigen::Vector3d chord_slope = out->azimuth_per_rotation - in->azimuth_per_rotation;
    const Eigen::Vector3d middle_slope =
        0.5 * (in->azimuth_per_rotation + out->azimuth_per_rotation);
    const Eigen::Vector2d across = centre_spin.head<2>();
    const Eigen::Vector3d centre_slope{across.x() * centre_spin.z() / across.squaredNorm(),
                                       across.y() * centre_spin.z() / across.squaredNorm(), -1.0};
    return BeamView{
        .disc_rad = disc_rad,
        .lead_rad = 0.5 * (before_rad - behind_rad),
        .disc_per_step_icrf = disc_slope_icrf(chord, disc_rad, by_step_icrf(chord_slope)),
        .lead_per_step_icrf = by_step_icrf(centre_slope - middle_slope),
        .chord_rad = chord.chord_rad};
  }

  /// Converts slopes by rotation: about the first axis of the frame a rotation moves the third
  /// against the second; about the second it moves it along the first.
  Eigen::Vector3d by_step_icrf(const Eigen::Vector3d& by_rotation) const {
    return R_icrf_spin_.col(0) * by_rotation.y() - R_icrf_spin_.col(1) * by_rotation.x();
  }

  /// Returns the slope of the half-angle of the sphere that has the chord, from chord and earth
  /// angle.
  Eigen::Vector3d disc_slope_icrf(const Chord& chord, double disc_rad,
                                  const Eigen::Vector3d& chord_slope_icrf) const {
    const double earth_rad = earth_angle_rad();
    const double along = std::sin(chord.mount_angle_rad) * std::cos(0.5 * chord.chord_rad);
    const double by_chord = -0.5 * std::sin(chord.mount_angle_rad) *
                            std::sin(0.5 * chord.chord_rad) * std::sin(earth_rad);
    const double by_earth =
        along * std::cos(earth_rad) - std::cos(chord.mount_angle_rad) * std::sin(earth_rad);
    const Eigen::Vector3d earth_slope_icrf =
        -(sightlines_.earth_icrf - std::cos(earth_rad) * axis_icrf_) / std::sin(earth_rad);
    return -(by_chord * chord_slope_icrf + by_earth * earth_slope_icrf) / std::sin(disc_rad);
  }

  /// Returns the view of the beam that has the measured chord from this axis, between one that
  /// misses and the Earth's centre. Its sphere leads to an axis from which the actual beam is as
  /// deep.
  BeamView beside(double mount_angle_rad, const EarthCrossing& crossing) const {
    const double chord_rad = crossing.chord ? crossing.chord->value_rad : 0.0;
    double narrower_rad = mount_angle_rad;
    double wider_rad = earth_angle_rad();
    BeamView view{.disc_rad = sightlines_.disc_rad};
    for (int i = 0; i < 40; ++i) {
      const double between_rad = 0.5 * (narrower_rad + wider_rad);
      const auto found = crossed_by(between_rad, crossing);
      if (found && found->chord_rad > chord_rad) {
        wider_rad = between_rad;
        view = {.disc_rad = found->disc_rad, .lead_rad = found->lead_rad};
      } else {
        narrower_rad = between_rad;
      }
    }
    return view;
  }

  HorizonAxes axes_;
  const SunEarthDirections& sightlines_;
  Eigen::Vector3d axis_icrf_;
  Eigen::Matrix3d R_icrf_spin_;
};

}  // namespace

BeamViews views_of_sphere(const SunEarthDirections& sun_earth) {
  return {BeamView{.disc_rad = sun_earth.disc_rad}, BeamView{.disc_rad = sun_earth.disc_rad}};
}

BeamViews views_of_horizon(const SpinConfig& config, const RevolutionMeasurements& measured,
                           const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf) {
  const Earth earth{config.horizon, sun_earth, axis_icrf};
  BeamViews views = views_of_sphere(sun_earth);
  for (const Side side : kSides) {
    const auto& beam = sensor_of(config, side);
    const auto& crossing = measured.crossing(side);
    if (beam && crossing) {
      views.at(index_of(side)) = earth.seen_by(beam->mount_angle_rad, *crossing);
    }
  }
  return views;
}

double lead_rad(const BeamViews& beams, const EdgeNoise& noise_rad) {
  double sum_rad = 0.0;
  int resting_on = 0;
  for (const Side side : kSides) {
    if (noise_rad(static_cast<Eigen::Index>(kInChannels.at(index_of(side)))) != 0.0) {
      sum_rad += beams.at(index_of(side)).lead_rad;
      ++resting_on;
    }
  }
  return resting_on > 0 ? sum_rad / resting_on : 0.0;
}

}  // namespace spindrift
