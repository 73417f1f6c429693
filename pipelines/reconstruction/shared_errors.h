/// @file
/// The errors that all attitudes of one reconstruction share: the gyro bias, and what the mission
/// file may be off by (three_axis/alignment.h) as far as these samples depend on it.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "pipelines/three_axis/alignment.h"

namespace spindrift {

/// First index of each group. The groups that an estimator may estimate come first.
enum SharedError {
  SharedGyroBias = 0,   ///< rad/s, body axes.
  SharedSunSensor = 3,  ///< As SunSensorError; so are those below.
  SharedStarTracker = 6,
  SharedGyro = 9,  ///< Scale, then axes.
  SharedStarTime = 18,
  SharedSunTime = 19,
};
inline constexpr int kSharedErrors = 20;

using SharedVector = Eigen::Matrix<double, kSharedErrors, 1>;
using SharedCovariance = Eigen::Matrix<double, kSharedErrors, kSharedErrors>;
/// Derivative of a vector by the shared errors.
using PerShared = Eigen::Matrix<double, 3, kSharedErrors>;
using PerGyroError = Eigen::Matrix<double, 3, 9>;

/// The index in AttitudeAlignment of each shared error behind the bias.
inline constexpr std::array<int, kSharedErrors - 3> kSharedAlignment{
    SunSensorError,       SunSensorError + 1,   SunSensorError + 2,  //
    StarTrackerError,     StarTrackerError + 1, StarTrackerError + 2,
    GyroScaleError,       GyroScaleError + 1,   GyroScaleError + 2,  //
    GyroAxisError,        GyroAxisError + 1,    GyroAxisError + 2,
    GyroAxisError + 3,    GyroAxisError + 4,    GyroAxisError + 5,  //
    StarTrackerTimeError, SunSensorTimeError};

/// Holds the covariance of the errors that remain in the shared quantities.
struct SharedErrors {
  SharedCovariance total;
  SharedCovariance noise;  ///< What would be left if the mission file were exact.
};

/// Returns the covariance of the shared errors before any sample.
SharedCovariance prior_of(double bias_sigma_rad_s, const AttitudeAlignment& alignment);

/// Returns the derivative of what the gyro measures by its scale and axis errors.
PerGyroError measured_per_gyro_error(const Eigen::Vector3d& rate_body_rad_s);

}  // namespace spindrift
