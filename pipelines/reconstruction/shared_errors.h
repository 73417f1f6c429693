/// @file
/// The errors that all attitudes of one reconstruction share: the gyro bias, and what the mission
/// file may be off by (three_axis/alignment.h) as far as these samples depend on it.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "pipelines/three_axis/alignment.h"

namespace spindrift {

/// First index of each group: those that `batch` estimates come first, those of the gyro are
/// adjacent.
enum SharedError {
  SharedSunSensor = 0,  ///< As SunSensorError; so are those below but the bias.
  SharedGyroBias = 3,   ///< rad/s, body axes.
  SharedGyro = 6,       ///< Scale, then axes.
  SharedStarTracker = 15,
  SharedStarTime = 18,
  SharedSunTime = 19,
};
inline constexpr int kSharedErrors = 20;

using SharedVector = Eigen::Matrix<double, kSharedErrors, 1>;
using SharedCovariance = Eigen::Matrix<double, kSharedErrors, kSharedErrors>;
/// Derivative of a vector by the shared errors.
using PerShared = Eigen::Matrix<double, 3, kSharedErrors>;
using PerGyroError = Eigen::Matrix<double, 3, 9>;

/// Number of shared errors that `batch` estimates: misalignment and bias.
inline constexpr int kEstimatedErrors = SharedGyro;
/// Number of those of the gyro, from the bias on.
inline constexpr int kTurnErrors = SharedStarTracker - SharedGyroBias;
/// Derivative of a turn by the errors of the gyro.
using PerTurnError = Eigen::Matrix<double, 3, kTurnErrors>;

/// The shared errors of the mission file, and their indices in AttitudeAlignment.
inline constexpr int kFileErrors = kSharedErrors - 3;
inline constexpr std::array<int, kFileErrors> kOfFile{0,  1,  2,  6,  7,  8,  9,  10, 11,
                                                      12, 13, 14, 15, 16, 17, 18, 19};
inline constexpr std::array<int, kFileErrors> kOfAlignment{
    SunSensorError,       SunSensorError + 1,   SunSensorError + 2,    //
    GyroScaleError,       GyroScaleError + 1,   GyroScaleError + 2,    //
    GyroAxisError,        GyroAxisError + 1,    GyroAxisError + 2,     //
    GyroAxisError + 3,    GyroAxisError + 4,    GyroAxisError + 5,     //
    StarTrackerError,     StarTrackerError + 1, StarTrackerError + 2,  //
    StarTrackerTimeError, SunSensorTimeError};

/// Holds the covariance of the errors that remain in the shared quantities.
struct SharedErrors {
  SharedCovariance total;
  /// What would be left of those that are estimated, or could be, if the mission file were exact.
  Eigen::Matrix<double, kEstimatedErrors, kEstimatedErrors> noise;
};

/// Returns the covariance of the shared errors before any sample.
SharedCovariance prior_of(double bias_sigma_rad_s, const AttitudeAlignment& alignment);

/// Returns the derivative of what the gyro measures by its scale and axis errors.
PerGyroError measured_per_gyro_error(const Eigen::Vector3d& rate_body_rad_s);

}  // namespace spindrift
