/// @file
/// Coning: the sensors' axis leans away from the principal axis that the body spins about.
///
/// The sensors, tipped in the body by a small rotation (c_x, c_y), x towards slit 1, meet their
/// edges at the azimuth
///
///     off = Re(conj(S) (c_x + i c_y) exp(i azimuth)),    S = s_x + i s_y
///
/// with the slopes s of tilt_signal.h: it is nutation that goes round once a turn. While Sun and
/// Earth stand still each channel is off by a constant, and six constants are all there is, of
/// which two go to the axis and one to the phase. To the beams coning is a change of mounting angle
/// and azimuth, to slit 2 one of cant and separation, to slit 1 a cant, which shows as far as the
/// Sun stands from the body's equator. So it is told from misplaced sensors only by how small those
/// are known to be, or as the geometry turns: an estimator that has both for unknowns, each error
/// of the model with its prior, has that in its covariance. One step from residuals is not enough,
/// since an axis that has taken coning for its own is off by several times as much.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/edge_prediction.h"

namespace spindrift {

/// Change of an edge's phase, rad/rad, with (c_x, c_y).
/// @param azimuth_rad Of slit 1 where the edge is expected: taken at its measured time, noise is
///                    multiplied by itself, and coning that is poorly seen comes out wrong.
Eigen::Vector2d phase_per_coning(const PredictedEdge& edge, double azimuth_rad);

struct ConingVerdict {
  double tilt_rad;
  double azimuth_rad;     ///< Behind slit 1, to which the sensors' axis leans, (-pi, pi].
  bool detected;          ///< What is not there shows as much in one of ten thousand passes.
  double detectable_rad;  ///< Tilt, in the direction known worst, found in 95 of 100 passes.
};

/// @param coning_rad (c_x, c_y).
/// @param covariance_rad2 Positive definite; what misplaced sensors leave open included.
ConingVerdict judge_coning(const Eigen::Vector2d& coning_rad,
                           const Eigen::Matrix2d& covariance_rad2);

}  // namespace spindrift
