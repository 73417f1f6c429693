/// @file
/// Allowed errors of the models of sensors and Earth. They are no noise: they do not average out,
/// and stay the same in every revolution.

#pragma once

#include <Eigen/Core>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/types/channel_offsets.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

/// What stays the same in every revolution and unlike noise does not average out: where the limb
/// lies for the north and the south beam (its mounting angle included), the sun angle, the azimuths
/// of the beams behind sun slit 1.
enum ModelError { NorthLimb, SouthLimb, SunAngleError, NorthAzimuth, SouthAzimuth };
inline constexpr int kModelErrors = 5;

/// What measurements say of these errors, the axis and all else that they determine eliminated.
struct ErrorInformation {
  Eigen::Matrix<double, kModelErrors, kModelErrors> information =
      Eigen::Matrix<double, kModelErrors, kModelErrors>::Zero();  ///< 1/rad^2
  /// 1/rad; its covariance is `information` where all errors are zero.
  Eigen::Matrix<double, kModelErrors, 1> score = Eigen::Matrix<double, kModelErrors, 1>::Zero();
  Considered<kModelErrors, kChannelOffsets> offsets = {};

  ErrorInformation& operator+=(const ErrorInformation& other) {
    information += other.information;
    score += other.score;
    offsets += other.offsets;
    return *this;
  }
  ErrorInformation& operator*=(double share) {
    information *= share;
    score *= share;
    offsets *= share;
    return *this;
  }
};

/// One standard deviation of what stays the same in every revolution: the beam's mounting angle,
/// the place of the limb, sun angle, azimuth. Infrared sensors and sun slits are aligned to a tenth
/// of a degree, and the height of the CO2 layer moves the limb by about as much.
inline constexpr double kModelError_rad = 0.15 * kRadPerDeg;

/// Beyond this, and several sigmas of the noise, two things contradict each other: all of the above
/// at three sigmas, or the oblate Earth's 0.2 deg together with two of them.
inline constexpr double kModelLimit_rad = 0.5 * kRadPerDeg;

}  // namespace spindrift
