/// @file
/// The least-squares problem of the `batch` method: attitudes at nodes in time, linked by the gyro,
/// tied to sun vectors and star fixes, with one gyro bias and one sun sensor misalignment. Its
/// residuals are
///
///     gyro   log(turn(bias)^-1 q_i^-1 q_j)             over the root of its covariance
///     sun    exp(misalignment) R(q)^T sun_icrf - s     over its noise
///     star   log(q_star^-1 q)                          over its noise
///     bias, misalignment                               over their prior sigmas
///
/// What else the mission file may be off by is not estimated (chain_covariance.h).
///
/// Attitude errors are small rotations about body axes. A sun vector leaves the rotation about
/// itself open, so that without a star fix the attitude is unobservable.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/reconstruction/observations.h"
#include "pipelines/reconstruction/rate_track.h"
#include "pipelines/reconstruction/shared_errors.h"

namespace spindrift {

struct ChainSun {
  std::size_t node;
  SunObservation of;
  Eigen::Vector3d rate_body_rad_s;
  /// How many times the variance of the noise it may be off by, since the mission file may be off.
  double allowed = 1.0;
};

struct ChainStar {
  std::size_t node;
  StarObservation of;
  Eigen::Vector3d rate_body_rad_s;
};

struct ChainNoise {
  double sun_rad;
  double star_rad;
  double bias_rad_s;
  AttitudeAlignment alignment = AttitudeAlignment::Zero();

  SharedCovariance prior() const { return prior_of(bias_rad_s, alignment); }
  bool estimates_misalignment() const;
  /// Returns the prior information on the sun sensor's misalignment.
  Eigen::Matrix3d on_misalignment() const;
};

struct Chain {
  std::vector<double> times_s;  ///< Node times since T2.
  std::vector<Turn> turns;      ///< Turns between adjacent nodes, corrected for `bias_rad_s`.
  Eigen::Vector3d bias_rad_s;   ///< Bias about which the turns are linearised.
  std::vector<ChainSun> sun;
  std::vector<ChainStar> stars;
  ChainNoise noise;
};

struct ChainState {
  std::vector<Eigen::Quaterniond> q_icrf_body;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d misalignment_rad = Eigen::Vector3d::Zero();
};

/// Builds a chain with a node at each sun vector, star fix and given time.
/// @param times_s Further node times, in any order.
Chain chain_of(const RateTrack& rates, std::vector<double> times_s,
               std::span<const SunObservation> sun, std::span<const StarObservation> stars,
               const Eigen::Vector3d& bias_rad_s, const ChainNoise& noise);

/// Propagates the attitude of one star fix to all nodes with the gyro turns.
ChainState started_at(const Chain& chain, const ChainStar& star);

/// Returns exp(misalignment) R(q)^T sun_icrf.
Eigen::Vector3d predicted_sun(const ChainState& state, const ChainSun& sun);

/// Holds a residual at a state with its derivatives by the node's attitude and the shared errors.
struct ChainResidual {
  Eigen::Vector3d off;
  Eigen::Matrix3d by_node;
  PerShared by_shared;
};

ChainResidual residual_of(const ChainSun& sun, const ChainState& state);
ChainResidual residual_of(const ChainStar& star, const ChainState& state);
/// Returns the residual of the turn behind node `i`; its derivatives are those of the turn.
Eigen::Vector3d gyro_residual(const Chain& chain, std::size_t i, const ChainState& state);

/// Returns the index of the node at `t_s`, which must be a node time.
std::size_t node_at(const Chain& chain, double t_s);

}  // namespace spindrift
