/// @file
/// What the mission file of a spinner may be off by: parameters b that one pass cannot check, with
/// their prior covariance B (design of the total covariance: P = P_noise + S B S').

#pragma once

#include <Eigen/Core>
#include <string_view>

namespace spindrift {

/// Errors of the mission file: true value minus that of the file.
enum SpinAlignmentError {
  SlitCantError,         ///< rad
  SlitSeparationError,   ///< rad
  NorthMountAngleError,  ///< rad
  SouthMountAngleError,  ///< rad
  NorthAzimuthError,     ///< rad
  SouthAzimuthError,     ///< rad
  Co2AltitudeError,      ///< km
  TimeTagError,          ///< s, of all channels together against the orbit: positive is late.
};
inline constexpr int kSpinAlignmentErrors = 8;

/// Prior covariance of the errors, in their units; zero where the file counts as exact.
using SpinAlignment = Eigen::Matrix<double, kSpinAlignmentErrors, kSpinAlignmentErrors>;

/// How the mission file names an error.
struct SpinAlignmentKey {
  std::string_view name;   ///< Dotted key of the value that is off, as in [calibration].
  std::string_view sigma;  ///< Key of the sigma in [spin.alignment].
  double unit;             ///< One unit of both keys in the unit of the error.
};
const SpinAlignmentKey& key_of(SpinAlignmentError error);

}  // namespace spindrift
