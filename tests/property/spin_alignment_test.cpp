/// Mission files that are off within what they state: the axis is within its sigma, and OK.

#include <gtest/gtest.h>

#include "pipelines/statistics/distributions.h"
#include "services/base/assessment_words.h"
#include "tests/support/misaligned_spin_passes.h"

namespace spindrift::testing::spin_alignment_test {

constexpr double kPass_s = 200.0;
constexpr int kPasses = 10;
constexpr double kChance = 1e-3;

TEST(SpinAlignment, ErrorsThatAreStatedAreInTheSigma) {
  MisalignedPasses passes{461, kPass_s};
  AlignmentSums sums;
  for (int i = 0; i < kPasses; ++i) {
    sums.add(passes.drawn(usual_alignment(), usual_alignment()), passes.orbit());
  }
  sums.record("stated");
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    SCOPED_TRACE(name_of(estimator));
    const auto i = static_cast<std::size_t>(estimator);
    EXPECT_GE(sums.answers.at(i), kPasses - 1);
    const double freedom = 2.0 * sums.answers.at(i);
    EXPECT_GT(sums.squares.at(i), chi_square_beyond(1.0 - kChance, freedom));
    EXPECT_LT(sums.squares.at(i), chi_square_beyond(kChance, freedom));
  }
  EXPECT_LT(sums.worst, 5.0);
}

}  // namespace spindrift::testing::spin_alignment_test
