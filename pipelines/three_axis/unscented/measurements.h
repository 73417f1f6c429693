/// @file
/// What the unscented filters measure, and how the errors of the sensors act on it.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/alignment.h"

namespace spindrift {

/// Holds a magnetic field measured in body axes and that of the model.
struct SeenField {
  Eigen::Vector3d body_nt;
  Eigen::Vector3d ref_icrf_nt;
  double noise_nt;  ///< One standard deviation of each component.
};

/// Holds a direction to the Sun measured in body axes, and the true one.
struct SeenSun {
  Eigen::Vector3d body;      ///< Unit vector.
  Eigen::Vector3d ref_icrf;  ///< Unit vector.
  double sigma_rad;          ///< Standard deviation along each of two axes across it.
};

/// Holds an attitude measured by a star tracker.
struct SeenStars {
  Eigen::Quaterniond q_icrf_body;  ///< Attitude; the sign is arbitrary.
  double sigma_rad;                ///< One standard deviation about each axis.
};

/// What a measurement says to a filter, before it is used. Sigma and NIS are total: they contain
/// what the filter does not know of the errors of the mission file.
struct UnscentedInnovation {
  /// Measured minus expected: a field in nT along body axes; of a direction the turn about two axes
  /// across it, and of an attitude that about body axes, in rad.
  Residual residual;
  double nis;
  /// Logarithm of the likelihood, relative to that of a measurement expected exactly, nats.
  double log_likelihood;
};

/// First index of each group of errors of the sensors, as AttitudeAlignmentError has them, which
/// are states of the filters with the prior of the mission file.
enum SensorErrorState {
  StarMounting = 0,
  SunMounting = 3,
  FieldMounting = 6,
  FieldBias = 9,
  StarTime = 12,
  SunTime = 13,
  FieldTime = 14,
};
inline constexpr int kSensorErrorStates = 15;

/// Indices of these states in an AttitudeAlignment.
inline constexpr std::array<int, kSensorErrorStates> kSensorErrors = {
    StarTrackerError,      StarTrackerError + 1,      StarTrackerError + 2,
    SunSensorError,        SunSensorError + 1,        SunSensorError + 2,
    MagnetometerError,     MagnetometerError + 1,     MagnetometerError + 2,
    MagnetometerBiasError, MagnetometerBiasError + 1, MagnetometerBiasError + 2,
    StarTrackerTimeError,  SunSensorTimeError,        MagnetometerTimeError};

}  // namespace spindrift
