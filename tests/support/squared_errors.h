/// @file
/// Normalised squared errors of the estimators over many random passes.

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/information_limit.h"
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

  void record() const {
    using ::testing::Test;
    Test::RecordProperty("mean", std::to_string(mean));
    Test::RecordProperty("sequential", std::to_string(sequential));
    Test::RecordProperty("rate", std::to_string(rate));
    Test::RecordProperty("model_off", model_off);
  }
};

inline SquaredErrors squared_errors_of(int passes, std::uint64_t seed) {
  const Surroundings from;
  std::mt19937_64 rng{seed};
  SquaredErrors sums;
  for (int pass = 0; pass < passes; ++pass) {
    const SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
    const SpinOutput output =
        run(SpinPass{body.config, from.orbit},
            from.pulses(body, 0.0, body.seconds_of(kStatisticsRevolutions), rng));
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
