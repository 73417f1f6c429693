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

namespace spindrift {

struct ChainSun {
  std::size_t node;
  SunObservation of;
};

struct ChainStar {
  std::size_t node;
  StarObservation of;
};

struct ChainNoise {
  double sun_rad;
  double star_rad;
  double bias_rad_s;
  std::optional<double> misalignment_rad;  ///< Empty if no misalignment is estimated.
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

/// Returns the index of the node at `t_s`, which must be a node time.
std::size_t node_at(const Chain& chain, double t_s);

}  // namespace spindrift
