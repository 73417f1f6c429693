/// @file
/// What the spin pipeline must know of a spacecraft: its sensors, their noise, its limits.

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

#include "pipelines/spin/types/alignment.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/spin/types/sensor_biases.h"

namespace spindrift {

/// A pair of slits, the second canted against the first, which lies in a meridian.
struct SunSensor {
  double slit_cant_rad;        ///< I, cant of slit 2, in (0, pi/2).
  double slit_separation_rad;  ///< psi0, azimuth of slit 2 behind slit 1 at the equator.
};

/// A pencil beam that sees the Earth's infrared disc.
struct InfraredSensor {
  double mount_angle_rad;  ///< gamma, angle from the spin axis, in (0, pi).
  double azimuth_rad;      ///< Azimuth behind sun slit 1: positive is crossed later.
  bool healthy = false;    ///< If so, silence contradicts an axis that shows it the Earth.
};

/// One standard deviation of the time of an edge.
struct PulseNoise {
  double sun_s;
  double infrared_s;
  /// Width of the grid that all times are cut or rounded to; 0: none.
  double grid_s = 0.0;

  bool operator==(const PulseNoise&) const = default;
};

/// Returns one sigma of the error that the grid adds to a time, uniform over its width. That
/// cutting shifts all times alike is no error of the time but a shift by half a width against the
/// orbit, which moves by metres meanwhile.
inline double grid_sigma_s(const PulseNoise& noise) {
  return noise.grid_s / (2.0 * std::numbers::sqrt3);
}

/// Returns one sigma of the time of an edge. Noise averages out over the edges of a channel. The
/// grid's error does so only where the spin rate is not commensurate with the grid; so it counts
/// once more, as an offset of each channel's times that is constant over the pass.
inline double edge_sigma_s(const PulseNoise& noise, PulseChannel channel) {
  return std::hypot(sees_the_sun(channel) ? noise.sun_s : noise.infrared_s, grid_sigma_s(noise));
}

enum class HorizonModel { Sphere, Ellipsoid };

struct Horizon {
  HorizonModel model;
  double co2_altitude_km;  ///< Height of the infrared horizon above the Earth's surface.
};

/// Settings of the rationality tests.
struct SpinScreening {
  int window = 100;             ///< Length in revolutions.
  double sigma = 3.0;           ///< Limit in standard deviations.
  double interference_s = 0.0;  ///< Edges of different channels closer than this spoil each other.
};

/// Limits on |Delta|, the determinant of the one-chord solution.
struct SpinGeometry {
  double determinant_usable = 0.03;     ///< Least |Delta| for the linear solution.
  double determinant_ambiguous = 0.01;  ///< Up to this |Delta| the two roots cannot be told apart.
};

/// Spin axis as expected beforehand.
struct SpinPrior {
  Eigen::Vector3d axis_icrf;  ///< Unit vector.
  double sigma_rad;
};

/// What the estimator `batch` determines beside axis and rate.
struct SpinBatch {
  std::optional<BiasSet> biases = {};  ///< Empty: the biases that the edges call for.
};

// No sensor has a default: a config is written as a whole, never default-constructed.
struct SpinConfig {
  SunSensor sun_sensor;
  std::optional<InfraredSensor> north;
  std::optional<InfraredSensor> south;
  PulseNoise noise;
  Horizon horizon;
  SpinScreening screening;
  SpinGeometry geometry;
  std::optional<SpinPrior> prior;
  SpinBatch batch = {};
  SpinAlignment alignment = SpinAlignment::Zero();
};

}  // namespace spindrift
