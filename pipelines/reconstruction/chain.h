/// @file
/// The problem of `batch`: attitudes at nodes in time, linked by what the gyro measured, held by
/// sun vectors and star fixes, with one gyro bias and one misalignment of the sun sensor.
///
///     gyro   log(turn(bias)^-1 q_i^-1 q_j)             by the root of its covariance
///     sun    exp(misalignment) R(q)^T sun_icrf - s     by its noise
///     star   log(q_star^-1 q)                          by its noise
///     bias, misalignment                               by their priors
///
/// Errors of attitudes are small rotations about body axes. A sun vector leaves the rotation about
/// itself open; without a star fix nothing is determined.

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
  std::optional<double> misalignment_rad;  ///< Empty: it is zero.
};

struct Chain {
  std::vector<double> times_s;  ///< Of the nodes.
  std::vector<Turn> turns;      ///< From each node to the next, with `bias_rad_s` taken off.
  Eigen::Vector3d bias_rad_s;   ///< About which the turns are linear in the bias.
  std::vector<ChainSun> sun;
  std::vector<ChainStar> stars;
  ChainNoise noise;
};

struct ChainState {
  std::vector<Eigen::Quaterniond> q_icrf_body;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d misalignment_rad = Eigen::Vector3d::Zero();
};

/// With nodes at these sun vectors, star fixes and times.
/// @param times_s In any order.
Chain chain_of(const RateTrack& rates, std::vector<double> times_s,
               std::span<const SunObservation> sun, std::span<const StarObservation> stars,
               const Eigen::Vector3d& bias_rad_s, const ChainNoise& noise);

/// Attitudes from one star fix on, both ways, by the turns.
ChainState started_at(const Chain& chain, const ChainStar& star);

/// exp(misalignment) R(q)^T sun_icrf
Eigen::Vector3d predicted_sun(const ChainState& state, const ChainSun& sun);

/// Of a time that is one of the nodes.
std::size_t node_at(const Chain& chain, double t_s);

}  // namespace spindrift
