/// `batch` finds coning where there is some, without moving the axis, and finds none otherwise.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "services/base/assessment_words.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_batch_coning_test {

double azimuth_off_rad(const BatchSolution& solution, const Coning& coning) {
  return wrapped_rad(solution.coning.verdict.azimuth_rad - coning.azimuth_rad);
}

TEST(SpinBatchConing, IsNotMadeUpInAHundredCleanPasses) {
  WobblingPasses passes{2411, 150.0};
  for (int pass = 0; pass < 100; ++pass) {
    const BatchSolution solution = passes.solution(passes.drawn());
    EXPECT_FALSE(solution.coning.verdict.detected) << sentence_of(solution.estimate.assessment);
    EXPECT_FALSE(has(solution.estimate.assessment, ReasonCode::Coning));
    ASSERT_TRUE(solution.nutation);
    EXPECT_FALSE(solution.nutation->found) << sentence_of(solution.estimate.assessment);
    // The tested nutation must not widen the covariance of the axis.
    EXPECT_NEAR(std::sqrt(solution.estimate.covariance_rad2.trace()) / solution.bound_rad, 1.003,
                0.001);
  }
}

TEST(SpinBatchConing, ThatIsAskedForIsFoundAndTheAxisIsThatOfTheSpin) {
  WobblingPasses passes{2412, 600.0};
  double squares = 0.0;
  double coning_squares = 0.0;
  constexpr int kPasses = 30;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    passes.config().batch.biases = unknowns_of(ConingX);
    // Drawn from the prior.
    truth.motion.coning = {
        .tilt_rad = 0.5 * kRadPerDeg * std::sqrt(-2.0 * std::log(passes.uniform())),
        .azimuth_rad = 2.0 * std::numbers::pi * passes.uniform()};
    const BatchSolution solution = passes.solution(truth);
    squares += axis_error(solution, truth).squares;
    const double tilt_off_rad = solution.coning.verdict.tilt_rad - truth.motion.coning.tilt_rad;
    coning_squares += std::pow(tilt_off_rad / solution.coning.tilt_sigma_rad, 2);
  }
  // The 95 % bands of chi-square with 60 and 30 degrees of freedom.
  EXPECT_GT(squares, 40.5);
  EXPECT_LT(squares, 83.3);
  EXPECT_GT(coning_squares, 16.8);
  EXPECT_LT(coning_squares, 47.0);
}

TEST(SpinBatchConing, OfADegreeIsFoundUnaskedWhereItCanBe) {
  WobblingPasses passes{2413, 900.0};
  int found = 0;
  for (int pass = 0; pass < 20; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.motion.coning = {.tilt_rad = 1.0 * kRadPerDeg,
                           .azimuth_rad = 2.0 * std::numbers::pi * passes.uniform()};
    const BatchSolution solution = passes.solution(truth);
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    if (!solution.coning.verdict.detected) {
      EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
      EXPECT_GT(solution.coning.verdict.detectable_rad, truth.motion.coning.tilt_rad);
      continue;
    }
    ++found;
    // Coning that was not configured is DOUBTFUL: it may have another cause.
    EXPECT_EQ(solution.estimate.assessment.quality, Quality::Doubtful);
    EXPECT_TRUE(has(solution.estimate.assessment, ReasonCode::Coning));
    EXPECT_NEAR(solution.coning.verdict.tilt_rad, truth.motion.coning.tilt_rad,
                3.0 * solution.coning.tilt_sigma_rad);
    EXPECT_NEAR(azimuth_off_rad(solution, truth.motion.coning), 0.0,
                4.0 * solution.coning.azimuth_sigma_rad);
    EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
  }
  EXPECT_GE(found, 18);
}

/// The model has no bias for an azimuth error of one beam; coning comes closest to it.
TEST(SpinBatchConing, ThatAMisplacedBeamLooksLikeIsDoubtedAndInTheSigma) {
  WobblingPasses passes{2414, 600.0};
  int coning = 0;
  for (int pass = 0; pass < 20; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.south->azimuth_rad += (0.05 + 0.15 * passes.uniform()) * kRadPerDeg;
    const BatchSolution solution = passes.solution(truth);
    SCOPED_TRACE(sentence_of(solution.estimate.assessment));
    if (solution.coning.verdict.detected) {
      ++coning;
      EXPECT_EQ(solution.estimate.assessment.quality, Quality::Doubtful);
      EXPECT_LT(axis_error(solution, truth).squares, kOneInAThousand);
    }
  }
  EXPECT_GT(coning, 0);
}

}  // namespace spindrift::testing::spin_batch_coning_test
