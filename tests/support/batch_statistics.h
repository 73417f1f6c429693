/// @file
/// Errors of the estimator `batch` over many simulated passes, compared with its covariance and
/// with the Cramer-Rao bound.

#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/bias_priors.h"
#include "tests/support/batch_pass.h"
#include "tests/support/normalised_square.h"

namespace spindrift::testing {

struct BatchStatistics {
  int passes = 0;
  int failures = 0;  ///< Passes without a solution or with one that is not OK.
  /// Sum of normalised squared axis errors: chi-square, two degrees of freedom a pass.
  double squares = 0.0;
  double over_bound = 0.0;  ///< Sum over passes of the squared error over the squared bound.
  double over_bound_variance = 0.0;  ///< Variance of `over_bound` by the covariances.
  /// Sum of normalised squared errors of the estimated biases: chi-square, one degree each.
  double bias_squares = 0.0;
  int biases = 0;
  int biases_beyond_three_sigmas = 0;

  double rms_over_bound() const { return std::sqrt(over_bound / passes); }
  /// Returns one standard deviation of `rms_over_bound` for an estimator that reaches the bound.
  double rms_noise() const { return 0.5 * std::sqrt(over_bound_variance) / passes; }
};

/// Holds what all passes of a statistic have in common.
struct PassKind {
  double turns;
  BiasSet estimated;
  Orbit orbit = transfer_orbit();
  SunEarthEphemeris around = seen_from(orbit);
};

/// Shifts edges as a wrong chord width and a wrong azimuth of the beams would.
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

/// Simulates a pass, solves it and adds its errors to `sums`.
/// @param biases True biases: the north chord's and dihedral's shift the edges, the south mounting
/// angle's is applied to the oracle itself.
inline void add_pass(const PassKind& kind, SpinningBody body, const SensorBiases& biases,
                     std::mt19937_64& rng, BatchStatistics& sums) {
  SpinConfig told = body.config;
  told.batch.biases = kind.estimated;
  body.config.south->mount_angle_rad += biases[SouthMountAngleBias];
  std::vector<Pulse> pulses =
      noisy_pulses(body, edges_of_turns(body, kind.around, kind.turns), rng);
  apply(body, biases, pulses);
  const Eigen::Vector3d start = start_near(body, 0.017, rng);
  const auto solution = solve_batch(told, kind.orbit, counted(body, pulses), {{start}});
  ++sums.passes;
  if (!solution || !is_unopposed(solution->estimate.assessment.quality)) {
    ++sums.failures;
    return;
  }
  const Eigen::Matrix2d& covariance_rad2 = solution->estimate.covariance_rad2;
  const Eigen::Vector2d error = error_rad(solution->estimate.axis_icrf, body.axis_icrf);
  sums.squares += normalised_square(error, covariance_rad2);
  sums.over_bound += error.squaredNorm() / (solution->bound_rad * solution->bound_rad);
  sums.over_bound_variance +=
      2.0 * covariance_rad2.squaredNorm() / std::pow(covariance_rad2.trace(), 2);
  for (const BiasEstimate& bias : solution->biases) {
    if (kind.estimated[static_cast<std::size_t>(bias.bias)] && bias.observable) {
      const double off = (bias.value - biases[bias.bias]) / bias.sigma;
      sums.bias_squares += off * off;
      sums.biases_beyond_three_sigmas += std::abs(off) > 3.0 ? 1 : 0;
      ++sums.biases;
    }
  }
}

/// Returns the covariance of beams that were placed together: one error of azimuth for both, one of
/// the south mounting angle, each of 0.15 deg.
inline SpinAlignment beams_placed_together() {
  using Errors = SpinAlignmentVector;
  const Errors azimuth = Errors::Unit(NorthAzimuthError) + Errors::Unit(SouthAzimuthError);
  const Errors mount = Errors::Unit(SouthMountAngleError);
  const double sigma_rad = 0.15 * kRadPerDeg;
  return sigma_rad * sigma_rad * (azimuth * azimuth.transpose() + mount * mount.transpose());
}

/// Runs passes whose biases are drawn from the priors that `beams_placed_together` gives them.
inline BatchStatistics many_passes(int passes, const PassKind& kind, std::uint64_t seed) {
  std::mt19937_64 rng{seed};
  std::normal_distribution<double> normal;
  BatchStatistics sums;
  for (int pass = 0; pass < passes; ++pass) {
    SpinningBody body = random_body(kind.around, 6.0 * kRadPerDeg, rng);
    if (kind.estimated.any()) {
      body.config.alignment = beams_placed_together();
    }
    // Those of beams do not depend on the sun angle.
    const SensorBiases sigmas = BiasPriors{body.config, 90.0 * kRadPerDeg}.stated();
    normal.reset();
    SensorBiases biases = SensorBiases::Zero();
    for (int i = 0; i < kSensorBiases; ++i) {
      if (kind.estimated[static_cast<std::size_t>(i)]) {
        biases[i] = normal(rng) * sigmas[i];
      }
    }
    add_pass(kind, body, biases, rng, sums);
  }
  return sums;
}

/// Runs passes that all have the given biases.
inline BatchStatistics many_passes_with(int passes, const PassKind& kind,
                                        const SensorBiases& biases, std::uint64_t seed) {
  std::mt19937_64 rng{seed};
  BatchStatistics sums;
  for (int pass = 0; pass < passes; ++pass) {
    add_pass(kind, random_body(kind.around, 6.0 * kRadPerDeg, rng), biases, rng, sums);
  }
  return sums;
}

/// Runs passes of 60 turns seen by both beams whose north chord is 0.3 deg too wide, with that bias
/// configured as unknown.
inline BatchStatistics many_passes_with_a_wide_north_chord(int passes, std::uint64_t seed) {
  SensorBiases biases = SensorBiases::Zero();
  biases[NorthChordBias] = 0.3 * kRadPerDeg;
  return many_passes_with(passes, {.turns = 60.0, .estimated = BiasSet{}.set(NorthChordBias)},
                          biases, seed);
}

}  // namespace spindrift::testing
