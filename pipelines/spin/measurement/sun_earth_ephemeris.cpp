#include "pipelines/spin/measurement/sun_earth_ephemeris.h"

#include <algorithm>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/spin/sensor_model/geometry.h"

namespace spindrift {
namespace {

TaiTime middle_of_chords(const RevolutionMeasurements& measured, TaiTime otherwise) {
  std::optional<TaiTime> first;
  std::optional<TaiTime> last;
  for (const auto& crossing : measured.crossings) {
    if (crossing) {
      first = std::min(first.value_or(crossing->t_mid()), crossing->t_mid());
      last = std::max(last.value_or(crossing->t_mid()), crossing->t_mid());
    }
  }
  return first ? *first + (*last - *first) / 2 : otherwise;
}

}  // namespace

Expected<SunEarthDirections> SunEarthEphemeris::sun_earth(const RevolutionMeasurements& measured,
                                                          TaiTime t) {
  const TaiTime t_sun = measured.t_sun1.value_or(t);
  const auto at_sun = orbit_.at(t_sun);
  if (!at_sun) {
    return Unexpected{at_sun.error()};
  }
  const TaiTime t_earth = middle_of_chords(measured, t_sun);
  const auto at_earth = orbit_.at(t_earth);
  if (!at_earth) {
    return Unexpected{at_earth.error()};
  }
  return earth_disc_half_angle_rad(at_earth->position_icrf_km.norm(), co2_altitude_km_)
      .map([&](double disc_rad) {
        return SunEarthDirections{.sun_icrf = sun_.direction_icrf(t_sun, *at_sun),
                                  .earth_icrf = -at_earth->position_icrf_km.normalized(),
                                  .disc_rad = disc_rad,
                                  .earth_pole_icrf = earth_pole_icrf(t),
                                  .t_earth = t_earth,
                                  .earth_motion_icrf_s = -at_earth->velocity_icrf_km_s /
                                                         at_earth->position_icrf_km.norm()};
      });
}

Expected<Sky> SunEarthEphemeris::sky(TaiTime t) {
  return orbit_.at(t).map([&](const OrbitState& spacecraft) {
    return Sky{.t = t,
               .spacecraft = spacecraft,
               .sun_icrf = sun_.direction_icrf(t, spacecraft),
               .earth_pole_icrf = earth_pole_icrf(t)};
  });
}

}  // namespace spindrift
