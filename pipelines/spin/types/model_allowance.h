/// @file
/// Allowed errors of the models of sensors and Earth, and of the times of a channel. They are no
/// noise: they do not average out, and stay the same in every revolution.

#pragma once

#include <Eigen/Core>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

/// @name Parameters that estimators consider (statistics/considered.h)
/// First the offset of each channel's times, constant over a pass, in s; then the errors of the
/// mission file (alignment.h) in their units.
/// @{
inline constexpr int kChannelOffsets = static_cast<int>(kPulseChannels);
inline constexpr int kSpinConsidered = kChannelOffsets + kSpinAlignmentErrors;

using PerConsidered = Eigen::Matrix<double, 1, kSpinConsidered>;
using ConsideredVector = Eigen::Matrix<double, kSpinConsidered, 1>;
using ConsideredPrior = Eigen::Matrix<double, kSpinConsidered, kSpinConsidered>;

/// Returns the prior of the mission file's errors, with all offsets known to be zero.
inline ConsideredPrior considered_prior(const SpinAlignment& alignment) {
  ConsideredPrior prior = ConsideredPrior::Zero();
  prior.bottomRightCorner<kSpinAlignmentErrors, kSpinAlignmentErrors>() = alignment;
  return prior;
}

/// Returns the part of a matrix over all considered parameters that holds the mission file's
/// errors.
inline SpinAlignment of_alignment(const ConsideredPrior& all) {
  return all.bottomRightCorner<kSpinAlignmentErrors, kSpinAlignmentErrors>();
}

/// Returns the prior of all. Where the spin rate is commensurate with the grid of the times, each
/// channel has an offset of its own. Elsewhere the grid's error averages out, and this prior is too
/// large.
inline ConsideredPrior considered_prior(const PulseNoise& noise,
                                        const SpinAlignment& alignment = SpinAlignment::Zero()) {
  ConsideredPrior prior = considered_prior(alignment);
  const double sigma_s = grid_sigma_s(noise);
  prior.diagonal().head<kChannelOffsets>().setConstant(sigma_s * sigma_s);
  return prior;
}
/// @}

/// Model errors: the place of the limb for the north and the south beam (mounting angle included),
/// the sun angle, and the azimuths of the beams behind sun slit 1.
enum ModelError { NorthLimb, SouthLimb, SunAngleError, NorthAzimuth, SouthAzimuth };
inline constexpr int kModelErrors = 5;

/// Information on the model errors, with the axis and all other unknowns eliminated.
struct ErrorInformation {
  Eigen::Matrix<double, kModelErrors, kModelErrors> information =
      Eigen::Matrix<double, kModelErrors, kModelErrors>::Zero();  ///< 1/rad^2
  /// Score, 1/rad; its covariance is `information` where all errors are zero.
  Eigen::Matrix<double, kModelErrors, 1> score = Eigen::Matrix<double, kModelErrors, 1>::Zero();
  Considered<kModelErrors, kSpinConsidered> considered = {};

  ErrorInformation& operator+=(const ErrorInformation& other) {
    information += other.information;
    score += other.score;
    considered += other.considered;
    return *this;
  }
  ErrorInformation& operator*=(double share) {
    information *= share;
    score *= share;
    considered *= share;
    return *this;
  }
};

/// One standard deviation of each model error. Infrared sensors and sun slits are aligned to a
/// tenth of a degree, and the height of the CO2 layer moves the limb by about as much.
inline constexpr double kModelError_rad = 0.15 * kRadPerDeg;

/// Two values contradict each other when they differ by more than this and several sigmas of noise:
/// it covers three kModelError_rad, or the oblate Earth's 0.2 deg and two of them.
inline constexpr double kModelLimit_rad = 0.5 * kRadPerDeg;

}  // namespace spindrift
