#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_batch_nutation_test {

TEST(SpinBatchNutation, IsTakenOutAndTheAxisReachesTheBound) {
  constexpr int kPasses = 120;
  WobblingPasses passes{2401, 150.0};
  double squares = 0.0;
  double error_rad2 = 0.0;
  double bound_rad2 = 0.0;
  double steady_rad2 = 0.0;
  int periods_taken_for_another = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    const auto steady = passes.solved(passes.edges(truth));
    truth.motion.nutation = passes.random_nutation(0.2 * kRadPerDeg);
    const auto solution = passes.solved(passes.edges(truth));
    ASSERT_TRUE(steady && solution) << pass;
    SCOPED_TRACE(sentence_of(solution->estimate.assessment));
    EXPECT_TRUE(is_unopposed(solution->estimate.assessment.quality));
    EXPECT_EQ(solution->noise, 1.0);
    ASSERT_TRUE(solution->nutation && solution->nutation->found);
    const FoundNutation& found = *solution->nutation->found;
    EXPECT_NEAR(found.half_angle_rad.value, 0.2 * kRadPerDeg, 4.0 * found.half_angle_rad.sigma);
    const double period_s =
        2.0 * std::numbers::pi / (truth.motion.rate_rad_s * truth.motion.nutation.per_turn());
    const auto is_true = [&](double found_s) {
      return std::abs(found_s - period_s) < 0.01 * period_s;
    };
    periods_taken_for_another += is_true(found.period_s.value) ? 0 : 1;
    EXPECT_TRUE(is_true(found.period_s.value) ||
                std::any_of(found.other_periods_s.begin(), found.other_periods_s.end(), is_true))
        << period_s;
    const AxisError error = axis_error(*solution, truth);
    squares += error.squares;
    error_rad2 += error.rad2;
    bound_rad2 += solution->bound_rad * solution->bound_rad;
    steady_rad2 += steady->bound_rad * steady->bound_rad;
  }
  // Noise sometimes hides which of the aliased frequencies is the true one.
  EXPECT_LE(periods_taken_for_another, 2);
  // The 95 % band of chi-square with 240 degrees of freedom.
  EXPECT_GT(squares, 199.0);
  EXPECT_LT(squares, 284.8);
  // The mean of 120 squares with two degrees of freedom: 5 % plus 1.645 of its standard deviations.
  EXPECT_LT(std::sqrt(error_rad2 / bound_rad2), 1.05 + 0.5 * 1.645 * std::sqrt(2.0 / 240.0));
  EXPECT_NEAR(std::sqrt(bound_rad2 / steady_rad2), 1.0, 0.03);
  RecordProperty("squares", std::to_string(squares));
  RecordProperty("rms over bound", std::to_string(std::sqrt(error_rad2 / bound_rad2)));
  RecordProperty("bound over steady", std::to_string(std::sqrt(bound_rad2 / steady_rad2)));
}

TEST(SpinBatchNutation, OfDegreesIsTakenOutToo) {
  WobblingPasses passes{2402, 200.0};
  for (const double half_angle_deg : {0.5, 1.0, 2.0, 4.0}) {
    SpinTruth truth = passes.drawn();
    truth.motion.nutation = passes.random_nutation(half_angle_deg * kRadPerDeg);
    const BatchSolution solution = passes.solution(truth);
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
    EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
    ASSERT_TRUE(solution.nutation->found);
    const FoundNutation& found = *solution.nutation->found;
    EXPECT_NEAR(found.half_angle_rad.value, half_angle_deg * kRadPerDeg,
                4.0 * found.half_angle_rad.sigma);
  }
}

TEST(SpinBatchNutation, ThatGrowsManyTimesIsFollowedFromStretchToStretch) {
  WobblingPasses passes{2403, 5400.0};
  SpinTruth truth = passes.drawn();
  truth.motion.nutation = passes.random_nutation(0.01 * kRadPerDeg);
  truth.motion.nutation.growth_per_s = 4.0 / 5400.0;
  const BatchSolution solution = passes.solution(truth);
  SCOPED_TRACE(sentence_of(solution.estimate.assessment));
  EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
  EXPECT_EQ(solution.noise, 1.0);
  EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
  ASSERT_TRUE(solution.nutation->found);
  const FoundNutation& found = *solution.nutation->found;
  EXPECT_NEAR(found.growth_per_s.value, truth.motion.nutation.growth_per_s,
              4.0 * found.growth_per_s.sigma);
  const double t_s = seconds_between(truth.start, solution.nutation_t);
  EXPECT_NEAR(found.half_angle_rad.value, truth.motion.nutation.half_angle_at_rad(t_s),
              4.0 * found.half_angle_rad.sigma);
}

TEST(SpinBatchNutation, ThatHasDiedOutIsTakenOutOfWhereItWas) {
  WobblingPasses passes{2404, 5400.0};
  SpinTruth truth = passes.drawn();
  truth.motion.nutation = passes.random_nutation(0.5 * kRadPerDeg);
  truth.motion.nutation.growth_per_s = -6.0 / 5400.0;
  const BatchSolution solution = passes.solution(truth);
  EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
  EXPECT_EQ(solution.noise, 1.0) << sentence_of(solution.estimate.assessment);
  EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
}

TEST(SpinBatchNutation, IsNotTakenForABiasNorABiasForIt) {
  WobblingPasses passes{2405, 600.0};
  for (int pass = 0; pass < 6; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.motion.nutation = passes.random_nutation(0.2 * kRadPerDeg);
    truth.north->chord_excess_rad = 0.3 * kRadPerDeg;
    const BatchSolution solution = passes.solution(truth);
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    const auto& reasons = solution.estimate.assessment.reasons;
    for (const double size : {number_of(reasons, ReasonCode::Bias, "value"),
                              number_of(reasons, ReasonCode::Nutation, "deg")}) {
      EXPECT_GT(size, 0.0);
      EXPECT_LT(size, 1.0);
    }
    EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
    EXPECT_EQ(solution.noise, 1.0);
  }
}

TEST(SpinBatchNutation, DoesNotHideAManoeuvreNorIsOneForIt) {
  for (const double half_angle_deg : {0.0, 0.2}) {
    WobblingPasses passes{2406, 600.0};
    SpinTruth before = passes.drawn();
    before.motion.nutation = passes.random_nutation(half_angle_deg * kRadPerDeg);
    SpinTruth after = before;
    after.motion.axis_icrf =
        Eigen::AngleAxisd{0.1 * kRadPerDeg, before.motion.axis_icrf.unitOrthogonal()} *
        before.motion.axis_icrf;
    const TaiTime moved = shifted(before.start, 300.0);
    const auto edges_before = passes.edges(before);
    const BatchSolution solution =
        passes.solution(joined(edges_before, passes.edges(after), moved));
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    ASSERT_TRUE(solution.changed);
    EXPECT_NEAR(seconds_between(moved, *solution.changed), 0.0, 20.0);
    EXPECT_EQ(solution.nutation->found.has_value(), half_angle_deg > 0.0);
    EXPECT_LT(axis_error(solution, after).squares, kOneInAThousand);
    EXPECT_EQ(solution.noise, 1.0);
  }
}

}  // namespace spindrift::testing::spin_batch_nutation_test
