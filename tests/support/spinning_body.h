/// @file
/// The oracle of the spin tests: turns a body with slits and pencil beams under Sun and Earth and
/// watches when the Sun crosses a slit's plane and when a beam meets the Earth. It searches, and
/// shares no formula with the code under test.

#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift::testing {

/// Semi-axes of the infrared horizon: a sphere of the Earth's equatorial radius raised by `h_km`.
Eigen::Vector3d spherical_horizon_km(double h_km);
/// The WGS-84 ellipsoid raised by `h_km`, its short axis along ICRF z.
Eigen::Vector3d ellipsoidal_horizon_km(double h_km);

/// What stands around the body, `t_s` seconds after the beginning.
struct SunEarthEphemeris {
  std::function<Eigen::Vector3d(double t_s)> sun_icrf;       ///< Any length.
  std::function<Eigen::Vector3d(double t_s)> earth_icrf_km;  ///< Spacecraft -> Earth's centre.
  Eigen::Vector3d horizon_km;                                ///< Semi-axes.
};

/// Sun and Earth at rest, and the spherical horizon 40 km up.
SunEarthEphemeris at_rest(const Eigen::Vector3d& sun_icrf, const Eigen::Vector3d& earth_icrf_km);

/// Turns right-handed about its axis, which is the body's +Z. Slit 1 is the half-plane of +X;
/// what lies behind it lies towards -Y.
struct SpinningBody {
  Eigen::Vector3d axis_icrf;  ///< Unit.
  double rate_rad_s;          ///< Positive.
  double first_turn_rad;      ///< How far it has turned when time begins.
  SpinConfig config;          ///< Mounting of the sensors.
};

/// Cant 45 deg, separation 35 deg; beams at 85 and 95 deg, 90 and 92 deg behind slit 1; noise
/// 0.1 ms (Sun) and 0.5 ms (infrared); infrared horizon 40 km up.
SpinConfig usual_config();

struct Edge {
  double t_s;
  PulseChannel channel;
};

/// The edges from `from_s` to `to_s`, in order of time, good to 1e-12 s. Chords narrower than half
/// a degree may go unseen.
std::vector<Edge> edges_between(const SpinningBody& body, const SunEarthEphemeris& around,
                                double from_s, double to_s);

/// The edges as telemetry, to the nearest nanosecond, in order.
std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start);
/// The same with Gaussian noise on every time.
std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start,
                               const PulseNoise& noise, std::mt19937_64& rng);

/// One whole turn as the body's sensors see it: a sun1, the sun2 that belongs to it, and the first
/// chord of either beam to begin behind sun1. The period is the true one.
Revolution revolution_seen(const SpinningBody& body, const SunEarthEphemeris& around,
                           TaiTime start);

}  // namespace spindrift::testing
