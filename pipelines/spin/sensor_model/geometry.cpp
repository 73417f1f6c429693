#include "pipelines/spin/sensor_model/geometry.h"

#include <fmt/format.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

constexpr double kAlike = 0.01;
constexpr double kInLine_rad = 3.0 * kRadPerDeg;
// Beyond this range no infrared sensor sees a disc; such a range was given in metres.
constexpr double kFarthest_km = 1.0e6;

}  // namespace

Expected<double> earth_disc_half_angle_rad(double range_km, double co2_altitude_km) {
  const double horizon_km = wgs84::kEquatorialRadius_km + co2_altitude_km;
  if (!(range_km > horizon_km && range_km < kFarthest_km)) {
    return Unexpected{
        {ErrorCode::Unobservable,
         fmt::format(
             "range {:.3f} km must lie between the infrared horizon's {:.3f} km and {:.0f} km",
             range_km, horizon_km, kFarthest_km)}};
  }
  return std::asin(horizon_km / range_km);
}

bool mount_angles_coincide(double one_rad, double other_rad) {
  return std::abs(std::cos(one_rad) - std::cos(other_rad)) < kAlike;
}

bool in_line(double sun_earth_rad) {
  return !(sun_earth_rad > kInLine_rad && sun_earth_rad < std::numbers::pi - kInLine_rad);
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
