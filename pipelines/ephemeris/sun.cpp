#include "pipelines/ephemeris/sun.h"

#include <erfa.h>
#include <erfam.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>

#include "pipelines/ephemeris/terrestrial_time.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

using std::chrono::hours;

constexpr double kAu_km = ERFA_DAU * 1e-3;
constexpr double kAuPerDay_km_s = kAu_km / ERFA_DAYSEC;
constexpr double kLight_km_s = ERFA_CMPS * 1e-3;

/// Returns the unit vector to an object at `relative_km` as an observer of that velocity sees it.
Eigen::Vector3d aberrated(const Eigen::Vector3d& relative_km,
                          const Eigen::Vector3d& velocity_km_s) {
  Eigen::Vector3d natural = relative_km.normalized();
  Eigen::Vector3d velocity_c = velocity_km_s / kLight_km_s;
  const double lorentz_reciprocal = std::sqrt(1.0 - velocity_c.squaredNorm());
  Eigen::Vector3d proper;
  eraAb(natural.data(), velocity_c.data(), relative_km.norm() / kAu_km, lorentz_reciprocal,
        proper.data());
  return proper;
}

}  // namespace

EarthMotion earth_motion(TaiTime t) {
  using RowMajor = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  // NOLINTBEGIN(*-avoid-c-arrays): ERFA's own types.
  double heliocentric_au_d[2][3];
  double barycentric_au_d[2][3];
  // NOLINTEND(*-avoid-c-arrays)
  // The status only warns of years outside 1900 to 2100: see the header.
  static_cast<void>(eraEpv00(kTaiEpoch_jd, tt_days(t), heliocentric_au_d, barycentric_au_d));
  const Eigen::Map<const RowMajor> heliocentric{&heliocentric_au_d[0][0]};
  const Eigen::Map<const RowMajor> barycentric{&barycentric_au_d[0][0]};
  return {.heliocentric_icrf_km = kAu_km * heliocentric.row(0).transpose(),
          .heliocentric_icrf_km_s = kAuPerDay_km_s * heliocentric.row(1).transpose(),
          .barycentric_icrf_km_s = kAuPerDay_km_s * barycentric.row(1).transpose()};
}

Eigen::Vector3d geometric_sun_icrf_km(TaiTime t) { return -earth_motion(t).heliocentric_icrf_km; }

/// Interpolates positions by the cubic Hermite polynomial, velocities linearly.
EarthMotion ApparentSun::interpolated_earth(TaiTime t) {
  const auto hour = std::chrono::floor<hours>(t);
  if (hour_ != hour.time_since_epoch().count()) {
    at_hour_ = earth_motion(hour);
    at_next_hour_ = earth_motion(hour + hours{1});
    hour_ = hour.time_since_epoch().count();
  }
  const double u = seconds_between(hour, t) / kHour_s;
  const double w = 1.0 - u;
  const EarthMotion& a = at_hour_;
  const EarthMotion& b = at_next_hour_;
  return {.heliocentric_icrf_km =
              w * w * (1.0 + 2.0 * u) * a.heliocentric_icrf_km +
              u * u * (1.0 + 2.0 * w) * b.heliocentric_icrf_km +
              kHour_s * u * w * (w * a.heliocentric_icrf_km_s - u * b.heliocentric_icrf_km_s),
          .heliocentric_icrf_km_s = w * a.heliocentric_icrf_km_s + u * b.heliocentric_icrf_km_s,
          .barycentric_icrf_km_s = w * a.barycentric_icrf_km_s + u * b.barycentric_icrf_km_s};
}

Eigen::Vector3d ApparentSun::direction_icrf(TaiTime t, const OrbitState& spacecraft) {
  const EarthMotion earth = interpolated_earth(t);
  const Eigen::Vector3d sun_now_km = -earth.heliocentric_icrf_km - spacecraft.position_icrf_km;
  // The light left the Sun at its position, relative to the barycentre, one light time ago.
  const Eigen::Vector3d sun_velocity_km_s =
      earth.barycentric_icrf_km_s - earth.heliocentric_icrf_km_s;
  const double light_time_s = sun_now_km.norm() / kLight_km_s;
  return aberrated(sun_now_km - light_time_s * sun_velocity_km_s, earth.barycentric_icrf_km_s);
}

bool is_in_shadow(const Eigen::Vector3d& position_icrf_km, const Eigen::Vector3d& sun_icrf) {
  return position_icrf_km.dot(sun_icrf) < 0.0 &&
         position_icrf_km.cross(sun_icrf).norm() < wgs84::kEquatorialRadius_km;
}

}  // namespace spindrift
