/// @file
/// Models coning: the sensors' axis leans away from the principal axis that the body spins about.
///
/// The sensors, tipped in the body by a small rotation (c_x, c_y), x towards slit 1, give their
/// edges at the azimuth
///
///     off = Re(conj(S) (c_x + i c_y) exp(i azimuth)),    S = s_x + i s_y
///
/// to first order, with the slopes s of tilt_signal.h, like nutation with one cycle a turn. While
/// Sun and Earth stand still, each channel has a constant offset; of these six constants, two go to
/// the axis and one to the phase. For beams, coning is a change of mounting angle and azimuth, for
/// slit 2 one of cant and separation, for slit 1 a cant, which shows when the Sun is off the body's
/// equator. So coning is separated from misplaced sensors only by their priors, or by changing
/// geometry. An estimator with both as unknowns, each model error with its prior, includes this in
/// its covariance. One step from residuals is not enough, since an axis that has absorbed coning is
/// off by several times as much.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Hold a slit or a beam on a body whose sensors' axis is tilted by coning, rotated exactly, since
/// the tilt may be a degree.
struct ConedSlit {
  SunSensor slit;
  Eigen::RowVector2d cant_per_coning;  ///< rad/rad
  Eigen::RowVector2d separation_per_coning;
};
struct ConedBeam {
  InfraredSensor beam;
  Eigen::RowVector2d mount_angle_per_coning;
  Eigen::RowVector2d azimuth_per_coning;
};
/// @param coning_rad Coning (c_x, c_y); derivatives are accurate to its third power.
ConedSlit as_coned(const SunSensor& slit, const Eigen::Vector2d& coning_rad);
ConedBeam as_coned(const InfraredSensor& beam, const Eigen::Vector2d& coning_rad);

struct ConingTest {
  double tilt_rad;
  double azimuth_rad;     ///< Azimuth behind slit 1 of the lean, (-pi, pi].
  bool detected;          ///< True with a false-alarm chance of 1e-4 per pass.
  double detectable_rad;  ///< Tilt found in 95 of 100 passes, in the direction known worst.
};

/// @param coning_rad Coning (c_x, c_y).
/// @param covariance_rad2 Positive definite covariance, including the effect of misplaced sensors.
ConingTest test_coning(const Eigen::Vector2d& coning_rad, const Eigen::Matrix2d& covariance_rad2);

}  // namespace spindrift
