/// @file
/// Coning: the sensors' axis leans away from the principal axis that the body spins about.
///
/// The sensors, tipped in the body by a small rotation (c_x, c_y), x towards slit 1, meet their
/// edges at the azimuth
///
///     off = Re(conj(S) (c_x + i c_y) exp(i azimuth)),    S = s_x + i s_y
///
/// to first order, with the slopes s of tilt_signal.h: it is nutation that goes round once a turn.
/// While Sun and Earth stand still each channel is off by a constant, and six constants are all
/// there is, of which two go to the axis and one to the phase. To the beams coning is a change of
/// mounting angle and azimuth, to slit 2 one of cant and separation, to slit 1 a cant, which shows
/// as far as the Sun stands from the body's equator. So it is told from misplaced sensors only by
/// how small those are known to be, or as the geometry turns: an estimator that has both for
/// unknowns, each error of the model with its prior, has that in its covariance. One step from
/// residuals is not enough, since an axis that has taken coning for its own is off by several times
/// as much.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/types/config.h"

namespace spindrift {

/// Where a slit or a beam is on a body whose sensors' axis is tilted by coning: by the exact
/// rotation, which may be of a degree.
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
/// @param coning_rad (c_x, c_y); derivatives are good to its third power.
ConedSlit as_coned(const SunSensor& slit, const Eigen::Vector2d& coning_rad);
ConedBeam as_coned(const InfraredSensor& beam, const Eigen::Vector2d& coning_rad);

struct ConingTest {
  double tilt_rad;
  double azimuth_rad;     ///< Behind slit 1, to which the sensors' axis leans, (-pi, pi].
  bool detected;          ///< What is not there shows as much in one of ten thousand passes.
  double detectable_rad;  ///< Tilt, in the direction known worst, found in 95 of 100 passes.
};

/// @param coning_rad (c_x, c_y).
/// @param covariance_rad2 Positive definite; what misplaced sensors leave open included.
ConingTest test_coning(const Eigen::Vector2d& coning_rad, const Eigen::Matrix2d& covariance_rad2);

}  // namespace spindrift
