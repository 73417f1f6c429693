/// Mission files that are off within what they state, over many passes: the normalised squared
/// errors of all estimators are as they claim, and as many rows are OK as with an exact file.

#include <gtest/gtest.h>

#include "pipelines/statistics/distributions.h"
#include "services/base/assessment_words.h"
#include "tests/support/misaligned_passes.h"

namespace spindrift::testing::spin_alignment_many_test {

constexpr double kPass_s = 300.0;
constexpr int kPasses = 200;
constexpr std::uint64_t kSeed = 462;

AlignmentSums sums_of(const SpinAlignment& states, const SpinAlignment& errors) {
  MisalignedPasses passes{kSeed, kPass_s};
  AlignmentSums sums;
  for (int i = 0; i < kPasses; ++i) {
    sums.add(passes.drawn(states, errors), passes.orbit());
  }
  return sums;
}

TEST(SpinAlignmentMany, SigmasAreTotal) {
  const AlignmentSums stated = sums_of(usual_alignment(), usual_alignment());
  stated.record("stated");
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    SCOPED_TRACE(name_of(estimator));
    const auto i = static_cast<std::size_t>(estimator);
    const double freedom = 2.0 * stated.answers.at(i);
    EXPECT_GT(stated.squares.at(i), chi_square_beyond(0.975, freedom));
    EXPECT_LT(stated.squares.at(i), chi_square_beyond(0.025, freedom));
  }
  EXPECT_LE(stated.beyond_four, stated.ok / 1000);
  EXPECT_LT(stated.worst, 5.0);

  const AlignmentSums exact = sums_of(SpinAlignment::Zero(), SpinAlignment::Zero());
  exact.record("exact");
  EXPECT_GE(stated.ok, exact.ok);
}

TEST(SpinAlignmentMany, ASunSensorOffByTwoDegreesIsDoubtedAndNamed) {
  MisalignedPasses passes{463, kPass_s};
  for (int i = 0; i < 20; ++i) {
    SpinningBody body = passes.body();
    body.config.alignment = usual_alignment();
    const double off_rad = (i % 2 == 0 ? 2.0 : -2.0) * kRadPerDeg;
    const MisalignedPass pass =
        passes.of(body, off_rad * SpinAlignmentVector::Unit(SlitSeparationError));
    const SpinOutput output = run(SpinPass{pass.said, passes.orbit()}, pass.pulses);
    const auto solution = solved(pass.said, passes.orbit(), output);
    ASSERT_TRUE(solution) << solution.error().message;
    const Assessment& assessment = solution->estimate.assessment;
    EXPECT_EQ(assessment.quality, Quality::Doubtful) << sentence_of(assessment);
    EXPECT_TRUE(has(assessment, ReasonCode::ModelOff)) << sentence_of(assessment);
  }
}

}  // namespace spindrift::testing::spin_alignment_many_test
