#include "pipelines/spin/geometry.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr double kEarthRadius_km = 6378.137;
// Mounting angles whose cosines differ by less (0.6 deg near the equator) leave theta_e to the
// noise.
constexpr double kAlike = 0.01;
// Beyond it no infrared sensor sees a disc; what is said to be there is in metres.
constexpr double kFarthest_km = 1.0e6;
constexpr double kPolarRadius_km = 6356.752314;  // WGS-84

double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

/// How badly theta_e fits cos(theta_se) = cos(theta_s)cos(theta_e) +
/// sin(theta_s)sin(theta_e)cos(lambda).
double misfit(const OneChordInput& input, double earth_angle_rad) {
  const double cos_sun_earth =
      std::cos(input.sun_angle_rad) * std::cos(earth_angle_rad) +
      std::sin(input.sun_angle_rad) * std::sin(earth_angle_rad) * std::cos(input.dihedral_rad);
  return std::abs(cos_sun_earth - std::cos(input.sun_earth_rad));
}

}  // namespace

Expected<double> earth_disc_half_angle_rad(double range_km, double co2_altitude_km) {
  const double horizon_km = kEarthRadius_km + co2_altitude_km;
  if (!(range_km > horizon_km && range_km < kFarthest_km)) {
    return Unexpected{
        {ErrorCode::Unobservable,
         fmt::format(
             "range {:.3f} km must lie between the infrared horizon's {:.3f} km and {:.0f} km",
             range_km, horizon_km, kFarthest_km)}};
  }
  return std::asin(horizon_km / range_km);
}

double oblateness_rad(double disc_rad) {
  return (1.0 - kPolarRadius_km / kEarthRadius_km) * std::sin(disc_rad);
}

Expected<double> earth_angle_from_two_chords(const Chord& north, const Chord& south) {
  const double sine = std::cos(north.mount_angle_rad) - std::cos(south.mount_angle_rad);
  const double cosine = std::sin(south.mount_angle_rad) * std::cos(0.5 * south.chord_rad) -
                        std::sin(north.mount_angle_rad) * std::cos(0.5 * north.chord_rad);
  if (std::abs(sine) < kAlike) {
    return Unexpected{{ErrorCode::Unobservable,
                       fmt::format("both infrared beams are mounted at {:.4f} deg: their chords "
                                   "do not determine the earth angle",
                                   degrees(north.mount_angle_rad))}};
  }
  // theta_e lies in (0, pi): its sine is positive whichever beam stands nearer the axis.
  return std::atan2(std::abs(sine), std::copysign(1.0, sine) * cosine);
}

double disc_seen_rad(const Chord& chord, double earth_angle_rad) {
  const double cosine =
      std::cos(chord.mount_angle_rad) * std::cos(earth_angle_rad) +
      std::sin(chord.mount_angle_rad) * std::sin(earth_angle_rad) * std::cos(0.5 * chord.chord_rad);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double determinant(const OneChordInput& input) {
  return std::cos(input.chord.mount_angle_rad) * std::sin(input.sun_angle_rad) *
             std::cos(input.dihedral_rad) -
         std::cos(input.sun_angle_rad) * std::sin(input.chord.mount_angle_rad) *
             std::cos(0.5 * input.chord.chord_rad);
}

double earth_angle_linear(const OneChordInput& input) {
  const double cos_mount = std::cos(input.chord.mount_angle_rad);
  const double chord_sine =
      std::sin(input.chord.mount_angle_rad) * std::cos(0.5 * input.chord.chord_rad);
  const double cos_disc = std::cos(input.disc_rad);
  const double cos_sun_earth = std::cos(input.sun_earth_rad);
  const double cosine = cos_disc * std::sin(input.sun_angle_rad) * std::cos(input.dihedral_rad) -
                        cos_sun_earth * chord_sine;
  const double sine = cos_mount * cos_sun_earth - std::cos(input.sun_angle_rad) * cos_disc;
  const double sign = std::copysign(1.0, determinant(input));
  return std::atan2(sign * sine, sign * cosine);
}

Expected<std::vector<double>> earth_angle_roots(const OneChordInput& input) {
  const double cos_mount = std::cos(input.chord.mount_angle_rad);
  const double chord_sine =
      std::sin(input.chord.mount_angle_rad) * std::cos(0.5 * input.chord.chord_rad);
  const double cosine = std::cos(input.disc_rad) / std::hypot(cos_mount, chord_sine);
  if (!(cosine <= 1.0)) {
    return Unexpected{{ErrorCode::Unobservable,
                       fmt::format("chord {:.4f} deg is wider than the Earth's disc of half-angle "
                                   "{:.4f} deg allows at mounting angle {:.4f} deg",
                                   degrees(input.chord.chord_rad), degrees(input.disc_rad),
                                   degrees(input.chord.mount_angle_rad))}};
  }
  const double centre_rad = std::atan2(chord_sine, cos_mount);
  std::vector<double> roots;
  for (const double root : {centre_rad - std::acos(cosine), centre_rad + std::acos(cosine)}) {
    if (root > 0.0 && root < std::numbers::pi) {
      roots.push_back(root);
    }
  }
  if (roots.empty()) {
    return Unexpected{
        {ErrorCode::Unobservable, "no earth angle in (0, 180) deg gives the measured chord"}};
  }
  std::sort(roots.begin(), roots.end(),
            [&](double a, double b) { return misfit(input, a) < misfit(input, b); });
  return roots;
}

Eigen::Vector3d axis_icrf(const AxisInput& input) {
  const Eigen::Vector3d normal = input.sun_icrf.cross(input.earth_icrf);
  const double cos_sun_earth = input.sun_icrf.dot(input.earth_icrf);
  const double cos_sun = std::cos(input.sun_angle_rad);
  const double cos_earth = std::cos(input.earth_angle_rad);
  const double triple = std::sin(input.sun_angle_rad) * std::sin(input.earth_angle_rad) *
                        std::sin(input.dihedral_rad);
  return ((cos_sun - cos_sun_earth * cos_earth) * input.sun_icrf +
          (cos_earth - cos_sun_earth * cos_sun) * input.earth_icrf + triple * normal) /
         normal.squaredNorm();
}

PredictedAngles predict_angles(const Eigen::Vector3d& axis_icrf, const Eigen::Vector3d& sun_icrf,
                               const Eigen::Vector3d& earth_icrf) {
  const double sine = axis_icrf.dot(sun_icrf.cross(earth_icrf));
  const double cosine =
      sun_icrf.dot(earth_icrf) - axis_icrf.dot(sun_icrf) * axis_icrf.dot(earth_icrf);
  return {.sun_angle_rad = angle_between_rad(axis_icrf, sun_icrf),
          .earth_angle_rad = angle_between_rad(axis_icrf, earth_icrf),
          .dihedral_rad = std::atan2(sine, cosine)};
}

std::optional<double> predict_chord_rad(double mount_angle_rad, double earth_angle_rad,
                                        double disc_rad) {
  const double cosine =
      (std::cos(disc_rad) - std::cos(mount_angle_rad) * std::cos(earth_angle_rad)) /
      (std::sin(mount_angle_rad) * std::sin(earth_angle_rad));
  if (!(std::abs(cosine) < 1.0)) {
    return std::nullopt;
  }
  return 2.0 * std::acos(cosine);
}

}  // namespace spindrift
