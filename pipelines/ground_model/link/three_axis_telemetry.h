/// @file
/// What gyro, sun sensor, star tracker and magnetometer send down of a body's motion, and what does
/// not arrive.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/geomagnetism/main_field_model.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/silence.h"
#include "pipelines/three_axis/magnetic_field.h"
#include "pipelines/three_axis/samples.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A sample at `from_s` behind the start, and one every step on to the end.
struct Sampling {
  double from_s;
  double step_s;
};

/// Noise is one standard deviation about each axis, of a magnetometer along it. What is read is
/// rounded to whole multiples of the resolution; 0: it is not.
struct TrueGyro {
  Sampling sampling;
  double noise_rad_s;
  Eigen::Vector3d bias_rad_s;
  std::optional<double> range_rad_s;  ///< It stops there; empty: nowhere.
  double resolution_rad_s = 0.0;      ///< About each axis.
};

/// Sees the Sun unless the Earth hides it.
struct TrueSunSensor {
  Sampling sampling;
  double noise_rad;
  double half_cone_rad;                                        ///< Of its field of view about -Z.
  Eigen::Vector3d misalignment_rad = Eigen::Vector3d::Zero();  ///< The small turn of its axes.
  double resolution = 0.0;  ///< Of each element of the unit vector.
};

/// @param sun_body Unit.
bool is_in_view(const TrueSunSensor& sensor, const Eigen::Vector3d& sun_body);

struct TrueStarTracker {
  Sampling sampling;
  double noise_rad;
  Eigen::Quaterniond q_body_sensor;  ///< The true one.
};

/// Reads the main field of the Earth.
struct TrueMagnetometer {
  Sampling sampling;
  double noise_nt;
  Eigen::Vector3d bias_nt;  ///< Body axes.
  MainFieldModel field;
  double resolution_nt = 0.0;  ///< Along each axis.
};

// A sensor that is empty is not on board.
struct ThreeAxisSensors {
  std::optional<TrueGyro> gyro;
  std::optional<TrueSunSensor> sun_sensor;
  std::optional<TrueStarTracker> star_tracker;
  std::optional<TrueMagnetometer> magnetometer = std::nullopt;
};

struct ThreeAxisFaults {
  double lost = 0.0;             ///< Probability that a sample does not arrive.
  double sun_outlier = 0.0;      ///< Probability that a sun vector is off,
  double sun_outlier_rad = 0.0;  ///< by so much, any way.
  std::vector<Silence> silences = {};
  std::vector<Silence> gyro_gaps = {};
};

struct ThreeAxisTelemetry {
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  std::vector<MagneticField> fields;
  std::vector<TaiTime> sun_outliers;  ///< Of `sun`.
  std::int64_t missing = 0;           ///< Measured, and did not arrive.
};

/// Draws as often whatever happens to a sample.
/// @param orbit To the end of the motion. @return NoCoverage where it does not reach, or where the
///        model of the field does not; InvalidInput where the field is asked for within the core.
Expected<ThreeAxisTelemetry> three_axis_telemetry(const BodyMotion& motion, TaiTime start,
                                                  const ThreeAxisSensors& sensors,
                                                  const ThreeAxisFaults& faults, const Orbit& orbit,
                                                  Chance& chance);

}  // namespace spindrift
