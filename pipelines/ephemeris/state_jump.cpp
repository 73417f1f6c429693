#include "pipelines/ephemeris/state_jump.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

// Within this a fall round the Earth's surface is good to a metre.
constexpr double kIntegration_s = 30.0;
constexpr double kTolerance_km = 10.0;
constexpr double kToleranceOfWay = 0.05;

struct Slope {
  Eigen::Vector3d velocity_km_s;
  Eigen::Vector3d acceleration_km_s2;
};

Slope slope_at(const OrbitState& state) {
  const double range_km = state.position_icrf_km.norm();
  return {.velocity_km_s = state.velocity_icrf_km_s,
          .acceleration_km_s2 =
              -kEarthMu_km3_s2 / (range_km * range_km * range_km) * state.position_icrf_km};
}

OrbitState moved(const OrbitState& state, const Slope& slope, double dt_s) {
  return {.position_icrf_km = state.position_icrf_km + dt_s * slope.velocity_km_s,
          .velocity_icrf_km_s = state.velocity_icrf_km_s + dt_s * slope.acceleration_km_s2};
}

/// Two-body motion, by Runge and Kutta's fourth order.
OrbitState fallen(OrbitState state, double duration_s) {
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kIntegration_s)));
  const double dt_s = duration_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Slope a = slope_at(state);
    const Slope b = slope_at(moved(state, a, 0.5 * dt_s));
    const Slope c = slope_at(moved(state, b, 0.5 * dt_s));
    const Slope d = slope_at(moved(state, c, dt_s));
    state = moved(moved(moved(moved(state, a, dt_s / 6.0), b, dt_s / 3.0), c, dt_s / 3.0), d,
                  dt_s / 6.0);
  }
  return state;
}

}  // namespace

std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to) {
  const double least_range_km =
      std::min(from.state.position_icrf_km.norm(), to.state.position_icrf_km.norm());
  if (to.t < from.t || to.t - from.t > std::chrono::hours{6} ||
      least_range_km < wgs84::kEquatorialRadius_km) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(from.t, to.t);
  const OrbitState expected = fallen(from.state, dt_s);
  const double off_km = (to.state.position_icrf_km - expected.position_icrf_km).norm();
  const double change_km_s = (to.state.velocity_icrf_km_s - expected.velocity_icrf_km_s).norm();
  const double speed_km_s =
      std::max(from.state.velocity_icrf_km_s.norm(), to.state.velocity_icrf_km_s.norm());
  const double tolerance_km = kTolerance_km + (kToleranceOfWay * speed_km_s + change_km_s) * dt_s;
  return off_km > tolerance_km ? std::optional{off_km} : std::nullopt;
}

}  // namespace spindrift
