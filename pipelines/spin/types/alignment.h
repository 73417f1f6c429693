/// @file
/// What the mission file of a spinner may be off by: parameters b that one pass cannot check, with
/// their prior covariance B (design of the total covariance: P = P_noise + S B S').

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
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

/// The mission file's key of each error, whose unit ends it: deg, km or s.
inline constexpr std::array<std::string_view, kSpinAlignmentErrors> kSpinAlignmentKeys = {
    "spin.sun_sensor.slit_cant_deg", "spin.sun_sensor.slit_separation_deg",
    "spin.ir.north.mount_angle_deg", "spin.ir.south.mount_angle_deg",
    "spin.ir.north.azimuth_deg",     "spin.ir.south.azimuth_deg",
    "spin.horizon.co2_altitude_km",  "spin.alignment.time_tag_s"};

/// Values of the errors, or of anything per error.
using SpinAlignmentVector = Eigen::Matrix<double, kSpinAlignmentErrors, 1>;

/// Prior covariance of the errors, in their units; zero where the file counts as exact.
using SpinAlignment = Eigen::Matrix<double, kSpinAlignmentErrors, kSpinAlignmentErrors>;

/// Returns a root of the covariance: errors are its product with independent ones of unit variance;
/// diagonal where the errors are independent.
inline SpinAlignment root_of(const SpinAlignment& alignment) {
  const Eigen::LDLT<SpinAlignment> parts{alignment};
  const SpinAlignmentVector sigmas = parts.vectorD().cwiseMax(0.0).cwiseSqrt();
  const SpinAlignment lower = parts.matrixL();
  const SpinAlignment sorted =
      parts.transpositionsP().transpose() * SpinAlignment{lower * sigmas.asDiagonal()};
  return sorted * parts.transpositionsP();
}

/// Returns whether the mission file states that it may be off.
inline bool is_stated(const SpinAlignment& alignment) { return (alignment.array() != 0.0).any(); }

}  // namespace spindrift
