#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/planning/pass_plan.h"
#include "pipelines/time/time_span.h"
#include "tests/support/batch_pass.h"
#include "tests/support/batch_statistics.h"
#include "tests/support/information_limit.h"

namespace spindrift::testing::spin_batch_test {

TEST(SpinBatch, ErrorsAreThoseThatTheCovariancePromises) {
  const BatchStatistics sums = many_passes(200, {.turns = 60.0, .estimated = {}}, 1777);
  EXPECT_EQ(sums.failures, 0);
  // The 95 % band of chi-square with 400 degrees of freedom.
  EXPECT_GT(sums.squares, 346.5);
  EXPECT_LT(sums.squares, 457.3);
}

TEST(SpinBatch, TheBoundIsThatOfTheInformationLimitAndThatOfThePlan) {
  const Surroundings from;
  std::mt19937_64 rng{1922};
  for (int pass = 0; pass < 8; ++pass) {
    const SpinningBody body = random_body(from.around, 4.0 * kRadPerDeg, rng);
    SpinConfig config = body.config;
    config.batch.biases = BiasSet{};
    const double turns = 60.0;
    const double duration_s = body.seconds_of(turns);
    const auto solution = solve_batch(
        config, from.orbit, noisy_pass(body, edges_of_turns(body, from.around, turns), rng),
        {{start_near(body, kRadPerDeg, rng)}});
    ASSERT_TRUE(solution) << solution.error().message;
    const double limit_rad = std::sqrt(cramer_rao_rad2(body, from.around, duration_s).trace());
    // The limit assumes a rate without drift, which hardly affects the axis.
    EXPECT_NEAR(solution->bound_rad / limit_rad, 1.0, 0.01) << "pass " << pass;
    // The prediction of `geometry` for the same pass.
    const TaiTime end = later_by_s(kTransferStart, duration_s);
    const auto plan = plan_pass(config, from.orbit,
                                {.from = kTransferStart,
                                 .to = end,
                                 .step_s = duration_s,
                                 .axis_icrf = body.axis_icrf,
                                 .rate_rad_s = body.rate_rad_s});
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_NEAR(solution->bound_rad / plan->steps.back().sigma_rad.value(), 1.0, 0.01)
        << "pass " << pass;
  }
}

struct TrueNoise {
  double sun_times;
  double infrared_times;
};

TEST(SpinBatch, NoiseBeyondWhatIsStatedIsDoubtedAndCovered) {
  constexpr int kPasses = 20;
  for (const TrueNoise& noise : {TrueNoise{3.0, 3.0}, TrueNoise{1.0, 5.0}, TrueNoise{4.0, 1.0}}) {
    const double times = std::max(noise.sun_times, noise.infrared_times);
    SCOPED_TRACE(times);
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= kPasses; ++seed) {
      BatchScene scene{seed};
      const SpinConfig stated = scene.body.config;
      scene.body.config.noise.sun_s *= noise.sun_times;
      scene.body.config.noise.infrared_s *= noise.infrared_times;
      const auto edges = scene.pass(200.0);
      scene.body.config = stated;
      const Eigen::Vector3d start = start_near(scene.body, kRadPerDeg, scene.rng);
      const auto solution = solve_batch(stated, scene.orbit, edges, {{start}});
      ASSERT_TRUE(solution) << solution.error().message;
      EXPECT_EQ(solution->estimate.assessment.quality, Quality::Doubtful);
      EXPECT_NEAR(solution->noise, times, 0.15 * times);
      squares += squared_error(solution->estimate, scene.body.axis_icrf);
    }
    // The 99 % band of chi-square with 40 degrees of freedom.
    EXPECT_GT(squares, 20.7);
    EXPECT_LT(squares, 66.8);
  }
}

}  // namespace spindrift::testing::spin_batch_test
