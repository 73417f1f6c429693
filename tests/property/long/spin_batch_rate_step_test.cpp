/// `batch` reports when the spin rate steps, as at spin-up and despin, and solves from there on.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipelines/spin/batch/changepoint.h"
#include "services/base/assessment_words.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_batch_rate_step_test {

constexpr double kRpm_rad_s = std::numbers::pi / 30.0;
constexpr double kStepAt_s = 240.0;

/// Returns the edges of a body whose rate steps while its azimuth stays continuous.
std::vector<PassEdge> stepped(WobblingPasses& passes, const SpinTruth& before, double step_rpm) {
  SpinTruth after = before;
  after.motion.rate_rad_s += step_rpm * kRpm_rad_s;
  after.motion.first_azimuth_rad -= step_rpm * kRpm_rad_s * kStepAt_s;
  const auto edges_before = passes.edges(before);
  return joined(edges_before, passes.edges(after), shifted(before.start, kStepAt_s));
}

TEST(SpinBatchRateStep, OfAnySizeIsDatedToATurnOrSoAndSolvedFromThereOn) {
  WobblingPasses passes{2501, 600.0};
  for (const double step_rpm : {-5.0, -0.3, 0.02, 0.05, 0.1, 0.5, 1.0, 5.0}) {
    SCOPED_TRACE(step_rpm);
    const SpinTruth truth = passes.drawn();
    const BatchSolution solution = passes.solution(stepped(passes, truth, step_rpm));
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    ASSERT_TRUE(solution.changed);
    // The edges of a smaller step take longer to leave the noise.
    EXPECT_NEAR(seconds_between(truth.start, *solution.changed), kStepAt_s,
                std::abs(step_rpm) < 0.04 ? 10.0 : 4.0);
    EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
    EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
    EXPECT_NEAR(solution.estimate.spin_rate_rad_s, truth.motion.rate_rad_s + step_rpm * kRpm_rad_s,
                4.0 * solution.estimate.spin_rate_sigma_rad_s);
  }
}

TEST(SpinBatchRateStep, IsNotSeenWhereTheRateDriftsOrTheBodyNutates) {
  WobblingPasses passes{2502, 600.0};
  for (int pass = 0; pass < 20; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.motion.rate_drift_rad_s2 = 1e-5 * passes.uniform();
    truth.motion.nutation = passes.random_nutation(0.2 * std::numbers::pi / 180.0);
    EXPECT_FALSE(find_rate_changepoint(passes.edges(truth)));
  }
}

TEST(SpinBatchRateStep, NeedsSomeEdges) {
  WobblingPasses passes{2503, 600.0};
  const auto edges = passes.edges(passes.drawn());
  EXPECT_FALSE(find_rate_changepoint({}));
  EXPECT_FALSE(find_rate_changepoint(std::span{edges}.first(40)));
}

}  // namespace spindrift::testing::spin_batch_rate_step_test
