#include "pipelines/ephemeris/state_jump.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/wgs84.h"

namespace spindrift {
namespace {

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

/// Returns an upper bound of the perturbations at a distance from the Earth's centre: J2 over the
/// poles, 3.2e-5 km/s^2 at the surface; Moon and Sun, 1.4e-8 in the geostationary ring, 4e-6 near
/// the Moon's orbit.
double left_out_km_s2(double range_km) {
  return 3.5e-5 * std::pow(wgs84::kEquatorialRadius_km / range_km, 4) +
         1.2e-8 * std::pow(range_km / 40'000.0, 3);
}

/// A state propagated by two-body motion, and bounds of its error.
struct Fall {
  OrbitState state;
  // States may be printed to no more digits than that.
  double bound_km = 1.0;
  double bound_km_s = 1e-3;
};

/// Grows the bounds by the perturbations, and by the error so far times 2 mu / r^3, gravity's
/// gradient.
void widen(Fall& fall, double dt_s) {
  const double range_km = fall.state.position_icrf_km.norm();
  const double gradient_s2 = 2.0 * kEarthMu_km3_s2 / std::pow(range_km, 3);
  fall.bound_km_s += dt_s * (left_out_km_s2(range_km) + gradient_s2 * fall.bound_km);
  fall.bound_km += dt_s * fall.bound_km_s;
}

/// Propagates a state by two-body motion with fourth-order Runge-Kutta.
Fall fall_from(const OrbitState& from, double duration_s) {
  // Steps of half a minute are accurate to a metre near the Earth's surface. The most steps last
  // for a month: no orbit is known that long from one state alone.
  const double steps = std::clamp(std::ceil(duration_s / 30.0), 1.0, 1e5);
  const double dt_s = duration_s / steps;
  Fall fall{.state = from};
  for (int i = 0; i < steps; ++i) {
    widen(fall, dt_s);
    OrbitState& state = fall.state;
    const Slope a = slope_at(state);
    const Slope b = slope_at(moved(state, a, 0.5 * dt_s));
    const Slope c = slope_at(moved(state, b, 0.5 * dt_s));
    const Slope d = slope_at(moved(state, c, dt_s));
    state = moved(moved(moved(moved(state, a, dt_s / 6.0), b, dt_s / 3.0), c, dt_s / 3.0), d,
                  dt_s / 6.0);
  }
  return fall;
}

bool inside_earth(const EphemerisPoint& point) {
  return point.state.position_icrf_km.norm() < wgs84::kEquatorialRadius_km;
}

/// Difference of a state from the propagated state before it.
struct Step {
  double off_km;
  double off_km_s;
  double manoeuvre_km;  ///< Part that the change of velocity could explain.
  double bound_km;      ///< Bound of the perturbations and of rounding.
  double bound_km_s;
};

/// Returns empty for a step that is not judged.
std::optional<Step> step_between(const EphemerisPoint& from, const EphemerisPoint& to) {
  if (to.t < from.t || to.t - from.t > std::chrono::hours{6} || inside_earth(from) ||
      inside_earth(to)) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(from.t, to.t);
  const Fall fall = fall_from(from.state, dt_s);
  const double change_km_s = (to.state.velocity_icrf_km_s - fall.state.velocity_icrf_km_s).norm();
  return Step{.off_km = (to.state.position_icrf_km - fall.state.position_icrf_km).norm(),
              .off_km_s = change_km_s,
              .manoeuvre_km = change_km_s * dt_s,
              .bound_km = fall.bound_km,
              .bound_km_s = fall.bound_km_s};
}

bool is_unexplained(const Step& step) { return step.off_km > step.bound_km + step.manoeuvre_km; }

const EphemerisPoint& last_usable(const OemSegment& segment) {
  return *std::prev(
      std::upper_bound(segment.points.begin(), segment.points.end(), segment.usable_to,
                       [](TaiTime t, const EphemerisPoint& point) { return t < point.t; }));
}

const EphemerisPoint& first_usable(const OemSegment& segment) {
  return *std::lower_bound(segment.points.begin(), segment.points.end(), segment.usable_from,
                           [](const EphemerisPoint& point, TaiTime t) { return point.t < t; });
}

}  // namespace

std::optional<double> jump_km(const EphemerisPoint& from, const EphemerisPoint& to) {
  const std::optional<Step> step = step_between(from, to);
  if (!step) {
    return std::nullopt;
  }
  const double speed_km_s =
      std::max(from.state.velocity_icrf_km_s.norm(), to.state.velocity_icrf_km_s.norm());
  const double tolerance_km =
      10.0 + 0.05 * speed_km_s * seconds_between(from.t, to.t) + step->manoeuvre_km;
  return step->off_km > tolerance_km ? std::optional{step->off_km} : std::nullopt;
}

std::optional<double> unexplained_km(const EphemerisPoint& from, const EphemerisPoint& to) {
  const std::optional<Step> step = step_between(from, to);
  return step && is_unexplained(*step) ? std::optional{step->off_km} : std::nullopt;
}

std::optional<Departure> departure(const EphemerisPoint& from, const EphemerisPoint& to) {
  const std::optional<Step> step = step_between(from, to);
  const bool off = step && (step->off_km > step->bound_km || step->off_km_s > step->bound_km_s);
  return off ? std::optional{Departure{.km = step->off_km, .km_s = step->off_km_s}} : std::nullopt;
}

std::optional<Eigen::Vector3d> halfway_icrf_km(const EphemerisPoint& from,
                                               const EphemerisPoint& to) {
  if (inside_earth(from) || inside_earth(to)) {
    return std::nullopt;
  }
  const double dt_s = seconds_between(from.t, to.t);
  const OrbitState halfway = fall_from(from.state, 0.5 * dt_s).state;
  const OrbitState whole = fall_from(halfway, 0.5 * dt_s).state;
  // Adds a cubic that is flat zero at `from` and closes the gap of two-body motion at `to`.
  return halfway.position_icrf_km + 0.5 * (to.state.position_icrf_km - whole.position_icrf_km) -
         0.125 * dt_s * (to.state.velocity_icrf_km_s - whole.velocity_icrf_km_s);
}

std::vector<OrbitJump> orbit_jumps(const OrbitEphemeris& ephemeris) {
  std::vector<OrbitJump> jumps;
  const auto judge = [&](const EphemerisPoint& from, const EphemerisPoint& to) {
    const std::optional<Step> step = step_between(from, to);
    if (step && is_unexplained(*step)) {
      jumps.push_back(
          {.to = to, .off_km = step->off_km, .off_km_s = step->off_km_s, .from = from.t});
    }
  };
  const OemSegment* before = nullptr;
  for (const OemSegment& segment : ephemeris.segments()) {
    if (before != nullptr) {
      judge(last_usable(*before), first_usable(segment));
    }
    for (std::size_t i = 1; i < segment.points.size(); ++i) {
      judge(segment.points[i - 1], segment.points[i]);
    }
    before = &segment;
  }
  return jumps;
}

}  // namespace spindrift
