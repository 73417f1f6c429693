/// @file
/// Errors of `batch` over many simulated passes, against what it promises and the Cramer-Rao bound.

#pragma once

#include <Eigen/Dense>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/spin/batch/batch_estimator.h"
#include "tests/support/batch_pass.h"

namespace spindrift::testing {

struct BatchStatistics {
  int passes = 0;
  int failures = 0;         ///< Without a solution, or not OK.
  double squares = 0.0;     ///< Normalised squared errors of the axis: chi-square, two a pass.
  double error_rad2 = 0.0;  ///< Sum over passes; likewise the following.
  double bound_rad2 = 0.0;
  double bias_squares = 0.0;  ///< Of the biases that were estimated: chi-square, one each.
  int biases = 0;
};

/// Shifts edges as a chord measured too wide and a wrong azimuth of the beams do.
inline void apply(const SpinningBody& body, const SensorBiases& biases,
                  std::vector<Pulse>& pulses) {
  for (Pulse& pulse : pulses) {
    double later_rad = 0.0;
    switch (pulse.channel) {
      case PulseChannel::NorthIn:
        later_rad = biases[DihedralBias] - 0.5 * biases[NorthChordBias];
        break;
      case PulseChannel::NorthOut:
        later_rad = biases[DihedralBias] + 0.5 * biases[NorthChordBias];
        break;
      case PulseChannel::SouthIn:
      case PulseChannel::SouthOut:
        later_rad = biases[DihedralBias];
        break;
      case PulseChannel::Sun1:
      case PulseChannel::Sun2:
        break;
    }
    pulse.t += std::chrono::nanoseconds{std::llround(1e9 * later_rad / body.rate_rad_s)};
  }
}

/// Biases of `estimated` are drawn from their priors: the north chord's, the dihedral's, and the
/// south mounting angle's, which the oracle itself has.
inline void add_pass(const Orbit& orbit, const Surroundings& around, double turns,
                     BiasSet estimated, std::mt19937_64& rng, BatchStatistics& sums) {
  SpinningBody body = random_body(around, 6.0 * 0.017453292519943295, rng);
  std::normal_distribution<double> normal;
  SensorBiases biases = SensorBiases::Zero();
  for (int i = 0; i < kSensorBiases; ++i) {
    biases[i] = estimated[static_cast<std::size_t>(i)]
                    ? normal(rng) * prior_of(static_cast<SensorBias>(i)).sigma
                    : 0.0;
  }
  SpinConfig told = body.config;
  told.batch.biases = estimated;
  body.config.south->mount_angle_rad += biases[SouthMountAngleBias];
  std::vector<Pulse> pulses =
      pulses_from(edges_of_turns(body, around, turns), kTransferStart, body.config.noise, rng);
  apply(body, biases, pulses);
  const Eigen::Vector3d start = start_near(body, 0.017, rng);
  const auto solution = solve_batch(told, orbit, counted(body, pulses), {{start}});
  ++sums.passes;
  if (!solution || !solution->estimate.status.starts_with("OK")) {
    ++sums.failures;
    return;
  }
  const Eigen::Vector2d error = error_rad(solution->estimate.axis_icrf, body.axis_icrf);
  sums.squares += error.dot(solution->estimate.covariance_rad2.ldlt().solve(error));
  sums.error_rad2 += error.squaredNorm();
  sums.bound_rad2 += solution->bound_rad * solution->bound_rad;
  for (const BiasEstimate& bias : solution->biases) {
    if (estimated[static_cast<std::size_t>(bias.bias)] && bias.observable) {
      sums.bias_squares += std::pow((bias.value - biases[bias.bias]) / bias.sigma, 2);
      ++sums.biases;
    }
  }
}

inline BatchStatistics many_passes(int passes, double turns, BiasSet estimated,
                                   std::uint64_t seed) {
  const Orbit orbit = transfer_orbit();
  const Surroundings around = seen_from(orbit, spherical_horizon_km(40.0));
  std::mt19937_64 rng{seed};
  BatchStatistics sums;
  for (int pass = 0; pass < passes; ++pass) {
    add_pass(orbit, around, turns, estimated, rng, sums);
  }
  return sums;
}

}  // namespace spindrift::testing
