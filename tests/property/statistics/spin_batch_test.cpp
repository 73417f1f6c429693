/// The covariance of `batch` is a promise, and its bound is that of Fisher.

#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/planning/pass_plan.h"
#include "pipelines/time/time_span.h"
#include "tests/support/batch_statistics.h"
#include "tests/support/information_limit.h"

namespace spindrift::spin_batch_test {

TEST(SpinBatch, ErrorsAreThoseThatTheCovariancePromises) {
  const testing::BatchStatistics sums =
      testing::many_passes(200, {.turns = 60.0, .estimated = {}}, 1777);
  EXPECT_EQ(sums.failures, 0);
  // 95 % of chi-square, 400 degrees of freedom.
  EXPECT_GT(sums.squares, 346.5);
  EXPECT_LT(sums.squares, 457.3);
}

TEST(SpinBatch, TheBoundIsThatOfTheInformationLimitAndThatOfThePlan) {
  const Orbit orbit = testing::transfer_orbit();
  const testing::SunEarthEphemeris around =
      testing::seen_from(orbit, testing::spherical_horizon_km(40.0));
  std::mt19937_64 rng{1922};
  for (int pass = 0; pass < 8; ++pass) {
    const testing::SpinningBody body = testing::random_body(around, 4.0 * kRadPerDeg, rng);
    SpinConfig config = body.config;
    config.batch.biases = BiasSet{};
    const double turns = 60.0;
    const double duration_s = turns * 2.0 * std::numbers::pi / body.rate_rad_s;
    const auto solution = solve_batch(
        config, orbit, testing::noisy_pass(body, testing::edges_of_turns(body, around, turns), rng),
        {{testing::start_near(body, kRadPerDeg, rng)}});
    ASSERT_TRUE(solution) << solution.error().message;
    const double limit_rad = std::sqrt(testing::cramer_rao_rad2(body, around, duration_s).trace());
    // The limit knows that the rate does not drift, which the axis hardly depends on.
    EXPECT_NEAR(solution->bound_rad / limit_rad, 1.0, 0.01) << "pass " << pass;
    // What `geometry` says beforehand.
    const TaiTime end = later_by_s(testing::kTransferStart, duration_s);
    const auto plan = plan_pass(config, orbit,
                                {.from = testing::kTransferStart,
                                 .to = end,
                                 .step_s = duration_s,
                                 .axis_icrf = body.axis_icrf,
                                 .rate_rad_s = body.rate_rad_s});
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_NEAR(solution->bound_rad / plan->steps.back().sigma_rad.value(), 1.0, 0.01)
        << "pass " << pass;
  }
}

}  // namespace spindrift::spin_batch_test
