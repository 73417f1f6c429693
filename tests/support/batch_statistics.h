/// @file
/// Errors of `batch` over many simulated passes, against what it promises and the Cramer-Rao bound.

#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "tests/support/batch_pass.h"
#include "tests/support/normalised_square.h"

namespace spindrift::testing {

struct BatchStatistics {
  int passes = 0;
  int failures = 0;         ///< Without a solution, or not OK.
  double squares = 0.0;     ///< Normalised squared errors of the axis: chi-square, two a pass.
  double over_bound = 0.0;  ///< Sum over passes of squared error over squared bound.
  double over_bound_variance = 0.0;  ///< Of that sum, by the covariances.
  double bias_squares = 0.0;         ///< Of the biases that were estimated: chi-square, one each.
  int biases = 0;
  int biases_beyond_three_sigmas = 0;

  double rms_over_bound() const { return std::sqrt(over_bound / passes); }
  /// One standard deviation of that, for an estimator that reaches the bound.
  double rms_noise() const { return 0.5 * std::sqrt(over_bound_variance) / passes; }
};

/// What the passes have in common.
struct PassKind {
  double turns;
  BiasSet estimated;
  Orbit orbit = transfer_orbit();
  SunEarthEphemeris around = seen_from(orbit, spherical_horizon_km(40.0));
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

/// @param biases North chord's, dihedral's, and the south mounting angle's, which the oracle itself
///        has.
inline void add_pass(const PassKind& kind, SpinningBody body, const SensorBiases& biases,
                     std::mt19937_64& rng, BatchStatistics& sums) {
  SpinConfig told = body.config;
  told.batch.biases = kind.estimated;
  body.config.south->mount_angle_rad += biases[SouthMountAngleBias];
  std::vector<Pulse> pulses = pulses_from(edges_of_turns(body, kind.around, kind.turns),
                                          kTransferStart, body.config.noise, rng);
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

/// Biases are drawn from their priors.
inline BatchStatistics many_passes(int passes, const PassKind& kind, std::uint64_t seed) {
  std::mt19937_64 rng{seed};
  std::normal_distribution<double> normal;
  BatchStatistics sums;
  for (int pass = 0; pass < passes; ++pass) {
    const SpinningBody body = random_body(kind.around, 6.0 * kRadPerDeg, rng);
    normal.reset();
    SensorBiases biases = SensorBiases::Zero();
    for (int i = 0; i < kSensorBiases; ++i) {
      if (kind.estimated[static_cast<std::size_t>(i)]) {
        biases[i] = normal(rng) * prior_of(static_cast<SensorBias>(i)).sigma;
      }
    }
    add_pass(kind, body, biases, rng, sums);
  }
  return sums;
}

/// All with these biases.
inline BatchStatistics many_passes_with(int passes, const PassKind& kind,
                                        const SensorBiases& biases, std::uint64_t seed) {
  std::mt19937_64 rng{seed};
  BatchStatistics sums;
  for (int pass = 0; pass < passes; ++pass) {
    add_pass(kind, random_body(kind.around, 6.0 * kRadPerDeg, rng), biases, rng, sums);
  }
  return sums;
}

/// A north chord 0.3 deg too wide, in a pass of 60 turns that both beams see, and said to be
/// unknown.
inline BatchStatistics many_passes_with_a_wide_north_chord(int passes, std::uint64_t seed) {
  SensorBiases biases = SensorBiases::Zero();
  biases[NorthChordBias] = 0.3 * kRadPerDeg;
  return many_passes_with(passes, {.turns = 60.0, .estimated = BiasSet{}.set(NorthChordBias)},
                          biases, seed);
}

}  // namespace spindrift::testing
