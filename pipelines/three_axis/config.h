/// @file
/// What the three-axis pipeline must know of a spacecraft: its sensors and its inertia.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace spindrift {

/// Errors are one standard deviation per axis and sample.
struct GyroSensor {
  double noise_rad_s;
  double bias_sigma_rad_s;            ///< One standard deviation of the bias.
  std::optional<double> range_rad_s;  ///< Beyond it the gyro is saturated.
};

struct DigitalSunSensor {
  double noise_rad;
  /// One standard deviation per axis of a constant misalignment, which a reconstruction by `batch`
  /// then estimates; empty: none.
  std::optional<double> misalignment_sigma_rad = std::nullopt;
};

struct StarTracker {
  Eigen::Quaterniond q_body_sensor;  ///< v_body = q v_sensor q*, unit.
  double noise_rad;
};

struct Magnetometer {
  double noise_nt;  ///< From the main field: with what crust and currents add to that.
};

struct Inertia {
  Eigen::Matrix3d kg_m2;  ///< About the centre of mass, body axes.
  double sigma_fraction;  ///< One standard deviation of each moment, as a part of it.
};

// A sensor that is empty is not on board.
struct ThreeAxisConfig {
  std::optional<GyroSensor> gyro;
  std::optional<DigitalSunSensor> sun_sensor;
  std::optional<StarTracker> star_tracker;
  std::optional<Magnetometer> magnetometer;
  std::optional<Inertia> inertia;
};

}  // namespace spindrift
