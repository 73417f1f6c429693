#include "pipelines/spin/measurement/mixed_azimuth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr int kSteps = 180;

/// Holds cos(theta_s)cos(theta_e) + sin(theta_s)sin(theta_e)cos(lambda) - cos(theta_se), which
/// vanishes at the solution, and its partial derivatives.
struct Misfit {
  double value;
  double by_lag;
  double by_earth_angle;
  double by_azimuth;
};

Misfit misfit_at(const MixedAzimuth& mixed, double lag_rad) {
  const double tan_cant = std::tan(mixed.sensor.slit_cant_rad);
  const double sin_lag = std::sin(lag_rad);
  const double length = std::hypot(tan_cant, sin_lag);
  const double cos_sun = sin_lag / length;
  const double sin_sun = tan_cant / length;
  const double sun_by_lag = -sin_sun * std::cos(lag_rad) / length;
  const double dihedral_rad = mixed.azimuth_rad + mixed.sensor.slit_separation_rad + lag_rad;
  const double cos_earth = std::cos(mixed.earth_angle_rad);
  const double sin_earth = std::sin(mixed.earth_angle_rad);
  const double cos_dihedral = std::cos(dihedral_rad);
  const double by_dihedral = -sin_sun * sin_earth * std::sin(dihedral_rad);
  const double by_sun = cos_sun * sin_earth * cos_dihedral - sin_sun * cos_earth;
  return {.value = cos_sun * cos_earth + sin_sun * sin_earth * cos_dihedral -
                   std::cos(mixed.sun_earth_rad),
          .by_lag = by_sun * sun_by_lag + by_dihedral,
          .by_earth_angle = sin_sun * cos_earth * cos_dihedral - cos_sun * sin_earth,
          .by_azimuth = by_dihedral};
}

double zero_between(const MixedAzimuth& mixed, double before_rad, double after_rad) {
  const bool rising = misfit_at(mixed, before_rad).value < 0.0;
  for (int i = 0; i < 50; ++i) {
    const double middle_rad = 0.5 * (before_rad + after_rad);
    ((misfit_at(mixed, middle_rad).value < 0.0) == rising ? before_rad : after_rad) = middle_rad;
  }
  return 0.5 * (before_rad + after_rad);
}

}  // namespace

std::optional<double> predict_mixed_azimuth_rad(const SunSensor& sensor, double sun_angle_rad,
                                                double dihedral_rad) {
  const double sin_lag = std::tan(sensor.slit_cant_rad) / std::tan(sun_angle_rad);
  if (!(std::abs(sin_lag) < 1.0)) {
    return std::nullopt;
  }
  return wrapped_rad(dihedral_rad - sensor.slit_separation_rad - std::asin(sin_lag));
}

SlitLags slit_lags(const MixedAzimuth& mixed) {
  SlitLags found{.lags = {}, .nearest_miss = 2.0};
  const auto lag_at = [](int step) {
    return std::numbers::pi * (static_cast<double>(step) / kSteps - 0.5);
  };
  double before = misfit_at(mixed, lag_at(0)).value;
  double slope_before = 0.0;
  for (int step = 1; step <= kSteps; ++step) {
    const double now = misfit_at(mixed, lag_at(step)).value;
    const double slope = now - before;
    if (slope * slope_before < 0.0) {  // An extremum, between two lags or near a missing pair.
      found.nearest_miss = std::min(found.nearest_miss, std::abs(before));
    }
    if ((before < 0.0) != (now < 0.0)) {
      const double lag_rad = zero_between(mixed, lag_at(step - 1), lag_at(step));
      const Misfit there = misfit_at(mixed, lag_rad);
      found.lags.push_back({.lag_rad = lag_rad,
                            .to_earth_angle = -there.by_earth_angle / there.by_lag,
                            .to_azimuth = -there.by_azimuth / there.by_lag});
    }
    slope_before = slope;
    before = now;
  }
  return found;
}

}  // namespace spindrift
