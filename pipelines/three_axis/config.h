/// @file
/// The sensors and the inertia of a spacecraft as the three-axis pipeline needs them.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "pipelines/three_axis/alignment.h"

namespace spindrift {

/// All noise values are one standard deviation per axis and sample.
struct GyroSensor {
  double noise_rad_s;
  double bias_sigma_rad_s;            ///< One standard deviation of the bias.
  std::optional<double> range_rad_s;  ///< Rate beyond which the gyro saturates.
};

/// A cone about a boresight; only its silence depends on it.
struct FieldOfView {
  Eigen::Vector3d boresight_body;  ///< Unit vector.
  double half_angle_rad;
};

struct DigitalSunSensor {
  double noise_rad;
  std::optional<FieldOfView> view = {};  ///< Field in which it sees the Sun; empty: all round.
};

struct StarTracker {
  Eigen::Quaterniond q_body_sensor;  ///< Rotation v_body = q v_sensor q*; unit quaternion.
  double noise_rad;
  std::optional<FieldOfView> view = {};  ///< Where neither Sun nor Earth may stand.
};

struct Magnetometer {
  double noise_nt;  ///< Relative to the main field, crust and currents included.
};

struct Inertia {
  Eigen::Matrix3d kg_m2;  ///< Tensor about the centre of mass, body axes.
  double sigma_fraction;  ///< Relative standard deviation of each principal moment.
};

/// The commanded attitude, which stands still in one of two frames.
struct NominalAttitude {
  enum class Frame { Icrf, Orbit };

  Frame frame;
  Eigen::Quaterniond q_frame_body;  ///< Unit quaternion.
};

// An empty member means that the spacecraft lacks the sensor, or that the inertia or the
// commanded attitude is unknown.
struct ThreeAxisConfig {
  std::optional<GyroSensor> gyro;
  std::optional<DigitalSunSensor> sun_sensor;
  std::optional<StarTracker> star_tracker;
  std::optional<Magnetometer> magnetometer;
  std::optional<Inertia> inertia;
  std::optional<NominalAttitude> nominal = {};
  AttitudeAlignment alignment = AttitudeAlignment::Zero();
};

}  // namespace spindrift
