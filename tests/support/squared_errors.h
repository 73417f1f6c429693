/// @file
/// Normalised squared errors of the estimators over many random passes.

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/information_limit.h"
#include "tests/support/normalised_square.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

inline constexpr double kStatisticsRevolutions = 150.0;

struct SquaredErrors {
  double mean = 0.0;
  double sequential = 0.0;
  double rate = 0.0;  ///< NEES of the rate of `mean`.
  int model_off = 0;  ///< Means that report a wrong model although it is right.
};

inline double squared_error(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf) {
  return normalised_square(error_rad(estimate.axis_icrf, true_icrf), estimate.covariance_rad2);
}

inline SquaredErrors squared_errors_of(int passes, std::uint64_t seed) {
  const Orbit orbit = transfer_orbit();
  const SunEarthEphemeris around = seen_from(orbit, spherical_horizon_km(40.0));
  std::mt19937_64 rng{seed};
  SquaredErrors sums;
  for (int pass = 0; pass < passes; ++pass) {
    const SpinningBody body = random_body(around, 8.0 * kRadPerDeg, rng);
    const auto edges = edges_between(
        body, around, 0.0, kStatisticsRevolutions * 2.0 * std::numbers::pi / body.rate_rad_s);
    const SpinOutput output = run(SpinPass{body.config, orbit},
                                  pulses_from(edges, kTransferStart, body.config.noise, rng));
    const SpinEstimate mean = last_estimate(output, SpinEstimator::Mean);
    const SpinEstimate sequential = last_estimate(output, SpinEstimator::Sequential);
    EXPECT_TRUE(is_unopposed(sequential.assessment.quality)) << sentence_of(sequential.assessment);
    EXPECT_FALSE(mean.assessment.quality == Quality::Doubtful) << sentence_of(mean.assessment);
    sums.model_off += has(mean.assessment, ReasonCode::ModelOff) ? 1 : 0;
    sums.mean += squared_error(mean, body.axis_icrf);
    sums.sequential += squared_error(sequential, body.axis_icrf);
    sums.rate += std::pow((mean.spin_rate_rad_s - body.rate_rad_s) / mean.spin_rate_sigma_rad_s, 2);
  }
  return sums;
}

}  // namespace spindrift::testing
