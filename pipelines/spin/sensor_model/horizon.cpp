#include "pipelines/spin/sensor_model/horizon.h"

#include <Eigen/Geometry>
#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

/// Represents F as a quadratic form in the direction, with the equatorial semi-axis as unit length.
class TangentForm {
 public:
  TangentForm(const HorizonAxes& axes, const EarthView& earth)
      : pole_{earth.pole_spin},
        axes_{axes},
        flattening_{std::pow(axes.equatorial_km / axes.polar_km, 2) - 1.0},
        stretched_{stretched(earth.spacecraft_spin_km / axes.equatorial_km)},
        outside_{earth.spacecraft_spin_km.dot(stretched_) / axes.equatorial_km - 1.0} {}

  /// Returns Q d.
  Eigen::Vector3d times(const Eigen::Vector3d& direction) const {
    return stretched_ * stretched_.dot(direction) - outside_ * stretched(direction);
  }
  /// Returns half the change of d.Q d per km of horizon height; all derivatives here are of F/2.
  double half_per_height(const Eigen::Vector3d& direction) const {
    const double along = stretched_.dot(direction);
    const double squeeze = direction.dot(stretched(direction));
    const double flattening_per_km = 2.0 * axes_.equatorial_km *
                                     (axes_.polar_km - axes_.equatorial_km) /
                                     std::pow(axes_.polar_km, 3);
    const double up = pole_.dot(stretched_) / (1.0 + flattening_);
    const double north = pole_.dot(direction);
    const double along_per_km = -along / axes_.equatorial_km + flattening_per_km * up * north;
    const double outside_per_km =
        -2.0 * (outside_ + 1.0) / axes_.equatorial_km + flattening_per_km * up * up;
    return along * along_per_km -
           0.5 * (flattening_per_km * north * north * outside_ + squeeze * outside_per_km);
  }
  /// Returns half the change of d.Q d per km that the spacecraft moves.
  Eigen::Vector3d half_per_position_km(const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d squeezed = stretched(direction);
    return (stretched_.dot(direction) * squeezed - direction.dot(squeezed) * stretched_) /
           axes_.equatorial_km;
  }
  bool points_down(const Eigen::Vector3d& direction) const {
    return stretched_.dot(direction) < 0.0;
  }

 private:
  Eigen::Vector3d stretched(const Eigen::Vector3d& v) const {
    return v + flattening_ * pole_.dot(v) * pole_;
  }

  Eigen::Vector3d pole_;
  HorizonAxes axes_;
  double flattening_;          ///< Flattening term (a/b)^2 - 1.
  Eigen::Vector3d stretched_;  ///< The vector M r.
  double outside_;             ///< The scalar r.M r - 1.
};

/// Returns the azimuth where the beam crosses the sphere about the ellipsoid; empty if it misses.
std::optional<double> first_guess_rad(double radius_km, const Eigen::Vector3d& spacecraft_spin_km,
                                      double mount_angle_rad, Crossing crossing) {
  const double range_km = spacecraft_spin_km.norm();
  const double sin_disc = radius_km / range_km;
  const Eigen::Vector3d earth_spin = -spacecraft_spin_km / range_km;
  const double cosine =
      (std::sqrt(1.0 - sin_disc * sin_disc) - std::cos(mount_angle_rad) * earth_spin.z()) /
      (std::sin(mount_angle_rad) * std::hypot(earth_spin.x(), earth_spin.y()));
  if (!(std::abs(cosine) < 1.0)) {
    return std::nullopt;
  }
  const double half_chord_rad = std::acos(cosine);
  return std::atan2(earth_spin.y(), earth_spin.x()) +
         (crossing == Crossing::In ? -half_chord_rad : half_chord_rad);
}

/// The cosine between beam and Earth changes by z.(beam x Earth) per azimuth.
double per_limb(const EarthView& earth, const Eigen::Vector3d& beam) {
  const Eigen::Vector3d across = beam.cross(earth.spacecraft_spin_km);
  return across.norm() / across.z();
}

}  // namespace

HorizonAxes horizon_axes(const Horizon& horizon) {
  const bool sphere = horizon.model == HorizonModel::Sphere;
  return {.equatorial_km = wgs84::kEquatorialRadius_km + horizon.co2_altitude_km,
          .polar_km = (sphere ? wgs84::kEquatorialRadius_km : wgs84::kPolarRadius_km) +
                      horizon.co2_altitude_km};
}

std::optional<LimbCrossing> limb_crossing(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, Crossing crossing) {
  const auto guess_rad =
      first_guess_rad(axes.equatorial_km, earth.spacecraft_spin_km, mount_angle_rad, crossing);
  if (!guess_rad) {
    return std::nullopt;
  }
  const TangentForm form{axes, earth};
  const double sin_mount = std::sin(mount_angle_rad);
  const double cos_mount = std::cos(mount_angle_rad);
  double azimuth_rad = *guess_rad;
  // Newton's method starts at the crossing of the sphere, which is at most 0.2 deg away. It
  // converges quadratically there, so that three or four steps suffice.
  for (int step = 0; step < 12; ++step) {
    const Eigen::Vector3d beam{sin_mount * std::cos(azimuth_rad), sin_mount * std::sin(azimuth_rad),
                               cos_mount};
    const Eigen::Vector3d gradient = form.times(beam);
    const Eigen::Vector3d slope = beam.cross(gradient);
    const double correction_rad = -0.5 * beam.dot(gradient) / slope.z();
    azimuth_rad += correction_rad;
    if (std::abs(correction_rad) < 1e-12) {
      const bool enters = slope.z() > 0.0;
      const Eigen::Vector3d per_rotation = -slope / slope.z();
      const Eigen::Vector3d outwards{cos_mount * std::cos(azimuth_rad),
                                     cos_mount * std::sin(azimuth_rad), -sin_mount};
      const double per_mount = -outwards.dot(gradient) / slope.z();
      const double per_height_km = -form.half_per_height(beam) / slope.z();
      // A chord that changes by more than this factor times the axis motion is about to vanish.
      const bool crosses = form.points_down(beam) && enters == (crossing == Crossing::In) &&
                           per_rotation.norm() < 30.0;
      return crosses ? std::optional{LimbCrossing{
                           .azimuth_rad = wrapped_rad(azimuth_rad),
                           .azimuth_per_rotation = per_rotation,
                           .azimuth_per_limb = per_limb(earth, beam),
                           .azimuth_per_mount = per_mount,
                           .azimuth_per_height_km = per_height_km,
                           .azimuth_per_position_km = -form.half_per_position_km(beam) / slope.z()}}
                     : std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<LimbDistance> limb_distance(const HorizonAxes& axes, const EarthView& earth,
                                          double mount_angle_rad, double azimuth_rad) {
  const TangentForm form{axes, earth};
  const double sine = std::sin(mount_angle_rad);
  const Eigen::Vector3d across{sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), 0.0};
  const Eigen::Vector3d beam = across + std::cos(mount_angle_rad) * Eigen::Vector3d::UnitZ();
  if (!form.points_down(beam)) {
    return std::nullopt;
  }
  const Eigen::Vector3d onwards = Eigen::Vector3d::UnitZ().cross(beam);
  const Eigen::Vector3d gradient = form.times(beam);
  return LimbDistance{.depth = 0.5 * beam.dot(gradient),
                      .depth_per_rotation = beam.cross(gradient),
                      .depth_bend = onwards.dot(form.times(onwards)) - across.dot(gradient)};
}

}  // namespace spindrift
