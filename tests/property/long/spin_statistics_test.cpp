#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/information_limit.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"
#include "tests/support/squared_errors.h"

namespace spindrift::spin_statistics_test {

TEST(SpinStatistics, ErrorsOfFortyPassesAreThoseThatTheirSigmasPromise) {
  const testing::SquaredErrors sums = testing::squared_errors_of(40, 121);
  RecordProperty("mean", std::to_string(sums.mean));
  RecordProperty("sequential", std::to_string(sums.sequential));
  RecordProperty("rate", std::to_string(sums.rate));
  RecordProperty("model_off", sums.model_off);
  // The 0.05 % and 99.95 % points of chi-square.
  EXPECT_GT(sums.mean, 44.79);  // 80 degrees of freedom.
  EXPECT_LT(sums.mean, 128.26);
  EXPECT_GT(sums.sequential, 44.79);
  EXPECT_LT(sums.sequential, 128.26);
  // The sigma of the rate allows for a wandering rate, which these passes do not have: it may be up
  // to three times the actual errors but never below. 40 degrees of freedom.
  EXPECT_GT(sums.rate, 40.0 / 9.0);
  EXPECT_LT(sums.rate, 76.09);
}

TEST(SpinStatistics, SigmaOfWholePassesIsThatOfTheInformationLimit) {
  const Orbit orbit = testing::transfer_orbit();
  const testing::SunEarthEphemeris around =
      testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
  std::mt19937_64 rng{123};
  for (int pass = 0; pass < 8; ++pass) {
    SCOPED_TRACE(pass);
    const testing::SpinningBody body = testing::random_body(around, 4.0 * kRadPerDeg, rng);
    const double duration_s =
        testing::kStatisticsRevolutions * 2.0 * std::numbers::pi / body.rate_rad_s;
    const auto edges = testing::edges_between(body, around, 0.0, duration_s);
    const SpinOutput output =
        testing::run(SpinPass{body.config, orbit},
                     testing::pulses_from(edges, testing::kTransferStart, body.config.noise, rng));
    const double limit_rad = std::sqrt(testing::cramer_rao_rad2(body, around, duration_s).trace());
    const double sequential_rad =
        testing::sigma_rad(testing::last_estimate(output, SpinEstimator::Sequential));
    EXPECT_NEAR(sequential_rad / limit_rad, 1.0, 0.05);
  }
}

}  // namespace spindrift::spin_statistics_test
