/// @file
/// What the mission file of a three-axis spacecraft may be off by: parameters b that one pass cannot
/// check, with their prior covariance B (total covariance: P = P_noise + S B S').

#pragma once

#include <Eigen/Core>

namespace spindrift {

/// First index of each group of errors. A sensor's mounting error turns what it measures, in body
/// axes: v_measured = exp([b]x) v_true. The gyro measures (1 + M) rate_true + bias, with the scale
/// errors on the diagonal of M. A positive time tag error stamps the sample too late.
enum AttitudeAlignmentError {
  StarTrackerError = 0,        ///< rad, about body x, y, z.
  SunSensorError = 3,          ///< rad, about body x, y, z.
  MagnetometerError = 6,       ///< rad, about body x, y, z.
  MagnetometerBiasError = 9,   ///< nT, along body x, y, z.
  GyroScaleError = 12,         ///< Diagonal of M.
  GyroAxisError = 15,          ///< rad, M at xy, xz, yx, yz, zx, zy.
  StarTrackerTimeError = 21,   ///< s against the gyro.
  SunSensorTimeError = 22,     ///< s
  MagnetometerTimeError = 23,  ///< s
  InertiaError = 24,           ///< Relative error of the three principal moments, ascending.
};
inline constexpr int kAttitudeAlignmentErrors = 27;

/// Prior covariance of the errors, in their units; zero where the file counts as exact.
using AttitudeAlignment =
    Eigen::Matrix<double, kAttitudeAlignmentErrors, kAttitudeAlignmentErrors>;

}  // namespace spindrift
