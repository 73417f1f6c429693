#include "pipelines/frames/local_frame.h"

#include <fmt/format.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

Expected<void> check(double latitude_rad, double longitude_rad, double distance_km) {
  if (!(std::abs(latitude_rad) <= kQuarter_rad)) {
    return Unexpected{
        {ErrorCode::InvalidInput,
         fmt::format("latitude {} deg: must lie in [-90, 90]", degrees(latitude_rad))}};
  }
  if (!std::isfinite(longitude_rad)) {
    return Unexpected{
        {ErrorCode::InvalidInput, fmt::format("longitude {}: must be a number", longitude_rad)}};
  }
  if (!std::isfinite(distance_km)) {
    return Unexpected{{ErrorCode::InvalidInput,
                       fmt::format("height or radius {}: must be a number", distance_km)}};
  }
  return {};
}

}  // namespace

Eigen::Quaterniond north_east_down(double latitude_rad, double longitude_rad) {
  return Eigen::AngleAxisd{longitude_rad, Vector3d::UnitZ()} *
         Eigen::AngleAxisd{-latitude_rad - kQuarter_rad, Vector3d::UnitY()};
}

Expected<LocalFrame> local_frame(const GeodeticPlace& place) {
  return check(place.latitude_rad, place.longitude_rad, place.height_km).map([&] {
    constexpr double a_km = wgs84::kEquatorialRadius_km;
    constexpr double b_km = wgs84::kPolarRadius_km;
    const double cosine = std::cos(place.latitude_rad);
    const double sine = std::sin(place.latitude_rad);
    const double support_km = std::hypot(a_km * cosine, b_km * sine);
    const double off_axis_km = (a_km * a_km / support_km + place.height_km) * cosine;
    const double along_axis_km = (b_km * b_km / support_km + place.height_km) * sine;
    return LocalFrame{
        .origin_itrf_km = {off_axis_km * std::cos(place.longitude_rad),
                           off_axis_km * std::sin(place.longitude_rad), along_axis_km},
        .q_itrf_ned = north_east_down(place.latitude_rad, place.longitude_rad)};
  });
}

Expected<LocalFrame> local_frame(const GeocentricPlace& place) {
  return check(place.latitude_rad, place.longitude_rad, place.radius_km).map([&] {
    const Eigen::Quaterniond q_itrf_ned = north_east_down(place.latitude_rad, place.longitude_rad);
    return LocalFrame{.origin_itrf_km = q_itrf_ned * Vector3d{0.0, 0.0, -place.radius_km},
                      .q_itrf_ned = q_itrf_ned};
  });
}

}  // namespace spindrift
