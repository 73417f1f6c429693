/// @file
/// The oracle of the spin tests: rotates a body with slits and pencil beams and searches for the
/// times at which the Sun crosses the plane of a slit and a beam meets the Earth. It shares no
/// formula with the code under test.

#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift::testing {

/// Returns semi-axes of the infrared horizon: a sphere of the equatorial radius plus `h_km`.
Eigen::Vector3d spherical_horizon_km(double h_km);
/// Returns semi-axes of the WGS-84 ellipsoid raised by `h_km`, short axis along ICRF z.
Eigen::Vector3d ellipsoidal_horizon_km(double h_km);

/// Returns semi-axes of the horizon 40 km up by this model of it.
Eigen::Vector3d usual_horizon_km(HorizonModel model);

/// Draws a direction, every one as likely.
Eigen::Vector3d random_direction(std::normal_distribution<double>& normal, std::mt19937_64& rng);

/// Holds Sun and Earth as functions of the time since the start, s.
struct SunEarthEphemeris {
  std::function<Eigen::Vector3d(double t_s)> sun_icrf;  ///< Sun direction, any length.
  /// Vector from spacecraft to Earth's centre.
  std::function<Eigen::Vector3d(double t_s)> earth_icrf_km;
  Eigen::Vector3d horizon_km;  ///< Semi-axes of the horizon.
};

/// Returns Sun and Earth at rest with the spherical horizon 40 km up.
SunEarthEphemeris at_rest(const Eigen::Vector3d& sun_icrf, const Eigen::Vector3d& earth_icrf_km);

/// Rotates right-handed about its axis, the body's +Z. Slit 1 is the half-plane of +X; positive
/// azimuth behind it is towards -Y.
struct SpinningBody {
  Eigen::Vector3d axis_icrf;  ///< Spin axis, unit vector.
  double rate_rad_s;          ///< Spin rate, positive.
  double first_turn_rad;      ///< Rotation angle at time 0.
  SpinConfig config;          ///< Mounting and noise of the sensors.

  /// Returns how long this many turns take, s.
  double seconds_of(double turns) const { return turns * 2.0 * std::numbers::pi / rate_rad_s; }
};

/// Returns the rotation from ICRF to the frame of the body about this axis before its first turn.
Eigen::Matrix3d spin_frame(const Eigen::Vector3d& axis_icrf);

/// Returns a configuration with cant 45 deg, slit separation 35 deg, beams at 85 and 95 deg from
/// the axis and 90 and 92 deg behind slit 1, noise 0.1 ms (Sun) and 0.5 ms (infrared), and an
/// infrared horizon 40 km up.
SpinConfig usual_config();

struct Edge {
  double t_s;
  PulseChannel channel;
};

/// Returns the edges from `from_s` to `to_s` in order of time, accurate to 1e-12 s. Chords narrower
/// than half a degree may be missed.
std::vector<Edge> edges_between(const SpinningBody& body, const SunEarthEphemeris& around,
                                double from_s, double to_s);

/// Returns the edges as telemetry in order of time, rounded to nanoseconds.
std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start);
/// Returns the edges as telemetry with Gaussian noise on every time.
std::vector<Pulse> pulses_from(const std::vector<Edge>& edges, TaiTime start,
                               const PulseNoise& noise, std::mt19937_64& rng);

/// Returns one whole revolution: a sun1, its sun2, and the first chord of either beam that begins
/// after sun1. The period is the true one.
Revolution revolution_seen(const SpinningBody& body, const SunEarthEphemeris& around,
                           TaiTime start);

}  // namespace spindrift::testing
