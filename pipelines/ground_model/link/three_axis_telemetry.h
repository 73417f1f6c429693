/// @file
/// Telemetry of gyro, sun sensor, star tracker and magnetometer for the motion of a body.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/geomagnetism/main_field.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/silence.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Sampling times: a first sample `from_s` after the start, then one every step until the end.
struct Sampling {
  double from_s;
  double step_s;
};

/// True gyro. The noise is a standard deviation about each axis (of a magnetometer, along each
/// axis). Readings are rounded to multiples of the resolution; 0: they are not.
struct TrueGyro {
  Sampling sampling;
  double noise_rad_s;
  Eigen::Vector3d bias_rad_s;
  std::optional<double> range_rad_s;  ///< Rate at which the reading saturates; empty: nowhere.
  double resolution_rad_s = 0.0;      ///< Resolution about each axis.
};

/// True sun sensor; it sees the Sun unless the Earth hides it.
struct TrueSunSensor {
  Sampling sampling;
  double noise_rad;
  double half_cone_rad;  ///< Half-angle of its field of view about -Z.
  Eigen::Vector3d misalignment_rad = Eigen::Vector3d::Zero();  ///< Small rotation of its axes.
  double resolution = 0.0;  ///< Resolution of each element of the unit vector.
};

/// @param sun_body Unit vector.
bool is_in_view(const TrueSunSensor& sensor, const Eigen::Vector3d& sun_body);

struct TrueStarTracker {
  Sampling sampling;
  double noise_rad;
  Eigen::Quaterniond q_body_sensor;  ///< True mounting attitude.
};

/// True magnetometer; it reads the main field of the Earth.
struct TrueMagnetometer {
  Sampling sampling;
  double noise_nt;
  Eigen::Vector3d bias_nt;  ///< Bias in body axes.
  MainFieldModel field;
  double resolution_nt = 0.0;  ///< Resolution along each axis.
};

// Sensors on board; a sensor that is not is empty.
struct ThreeAxisSensors {
  std::optional<TrueGyro> gyro;
  std::optional<TrueSunSensor> sun_sensor;
  std::optional<TrueStarTracker> star_tracker;
  std::optional<TrueMagnetometer> magnetometer = std::nullopt;
};

struct ThreeAxisFaults {
  double lost = 0.0;             ///< Probability that a sample does not arrive.
  double sun_outlier = 0.0;      ///< Probability that a sun vector is off,
  double sun_outlier_rad = 0.0;  ///< by this angle, in any direction.
  std::vector<Silence> silences = {};
  std::vector<Silence> gyro_gaps = {};
};

struct ThreeAxisTelemetry {
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  std::vector<MagneticField> fields;
  std::vector<TaiTime> sun_outliers;  ///< Times of the outliers in `sun`.
  std::int64_t missing = 0;           ///< Number of samples measured that did not arrive.
};

/// Simulates the telemetry. The number of random draws is the same whatever happens to a sample.
/// @param orbit Must reach to the end of the motion.
/// @return NoCoverage where the orbit or the field model does not reach; InvalidInput where the
///         field is asked for within the core.
Expected<ThreeAxisTelemetry> three_axis_telemetry(const BodyMotion& motion, TaiTime start,
                                                  const ThreeAxisSensors& sensors,
                                                  const ThreeAxisFaults& faults, const Orbit& orbit,
                                                  Chance& chance);

}  // namespace spindrift
