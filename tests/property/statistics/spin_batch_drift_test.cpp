#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_batch_drift_test {

TEST(SpinBatchDrift, ErrorsAreThoseThatItsSigmaPromises) {
  constexpr int kPasses = 100;
  WobblingPasses passes{2601, 120.0};
  double squares = 0.0;
  double least_sigmas = 1e9;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.motion.rate_drift_rad_s2 = 2e-5 * (passes.uniform() - 0.5);
    const BatchSolution solution = passes.solution(truth);
    EXPECT_TRUE(is_unopposed(solution.estimate.assessment.quality));
    const double sigma_rad_s2 = solution.drift_sigma_rad_s2;
    squares += std::pow((solution.drift_rad_s2 - truth.motion.rate_drift_rad_s2) / sigma_rad_s2, 2);
    least_sigmas = std::min(least_sigmas, 1e-5 / sigma_rad_s2);
  }
  // The 95 % band of chi-square with 100 degrees of freedom.
  EXPECT_GT(squares, 74.2);
  EXPECT_LT(squares, 129.6);
  // The drifts must exceed the noise.
  EXPECT_GT(least_sigmas, 3.0);
}

}  // namespace spindrift::testing::spin_batch_drift_test
