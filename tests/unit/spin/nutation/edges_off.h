/// @file
/// Residuals of a steady spin with errors chosen by the test, as input of the nutation search.

#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/nutation/tilt_signal.h"

namespace spindrift::testing {

/// Describes a channel with one edge a turn.
struct SteadyChannel {
  PulseChannel channel;
  double behind_turns;
  Eigen::Vector2d per_tilt;
};

/// Sorted by channel.
inline const std::vector<SteadyChannel> kSteadyChannels = {
    {PulseChannel::Sun1, 0.0, {0.1, 0.2}},
    {PulseChannel::Sun2, 0.1, {-0.6, 0.8}},
    {PulseChannel::NorthIn, 0.4, {1.4, 0.3}},
    {PulseChannel::NorthOut, 0.6, {-1.1, -0.5}}};
inline constexpr double kSteadyPeriod_s = 0.8;
inline constexpr double kSteadySigma_rad = 1e-3;

/// Returns the delay of an edge, rad.
using Off = std::function<double(const SteadyChannel& channel, double turns)>;

/// Returns the residuals turn by turn.
inline std::vector<UniformSpinResidual> edges_off(const std::vector<SteadyChannel>& channels,
                                                  int turns, const Off& off_rad,
                                                  double sigma_rad = kSteadySigma_rad) {
  std::vector<UniformSpinResidual> residuals;
  for (int turn = 0; turn < turns; ++turn) {
    for (const SteadyChannel& channel : channels) {
      const double at = turn + channel.behind_turns;
      residuals.push_back(
          {.channel = channel.channel,
           .t_s = kSteadyPeriod_s * at,
           .turns = at,
           .off_rad = off_rad(channel, at),
           .sigma_rad = sigma_rad,
           .expected = {.phase_rad = 0.0,
                        .phase_per_rotation = {channel.per_tilt.x(), channel.per_tilt.y(), -1.0},
                        .phase_per_error = Eigen::Matrix<double, 1, kModelErrors>::Zero(),
                        .phase_per_bias = Eigen::Matrix<double, 1, kSensorBiases>::Zero()}});
    }
  }
  return residuals;
}

inline Off off_by_noise(double sigma_rad, unsigned seed) {
  return [rng = std::mt19937_64{seed}, sigma_rad](const SteadyChannel&, double) mutable {
    return sigma_rad * std::normal_distribution<double>{}(rng);
  };
}

inline Off sum_of(Off one, Off other) {
  return
      [one = std::move(one), other = std::move(other)](const SteadyChannel& channel, double turns) {
        return one(channel, turns) + other(channel, turns);
      };
}

/// Returns the residuals of a body tilted by a rotation of constant size whose direction rotates at
/// a constant rate.
/// @param first_rad Direction of the rotation at turn 0.
inline Off off_by_circle(double size_rad, double per_turn, double first_rad) {
  return [=](const SteadyChannel& channel, double turns) {
    const double towards_rad = kTurn_rad * per_turn * turns + first_rad;
    return size_rad *
           channel.per_tilt.dot(Eigen::Vector2d{std::cos(towards_rad), std::sin(towards_rad)});
  };
}

}  // namespace spindrift::testing
