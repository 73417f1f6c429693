/// For a nutating body `sequential` follows the mean axis, reports oscillating residuals and has a
/// consistent covariance. (`batch` removes the nutation.)

#include <gtest/gtest.h>

#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_sequential_nutation_test {

constexpr double kSigmas = 5.0;

/// The first turns of a nutating body look like those of another axis, so they must be CONVERGING.
void expect_no_wrong_row_is_ok(const SpinOutput& output, const SpinMotion& motion) {
  for (const SpinEstimate& row : estimates_of(output, SpinEstimator::Sequential)) {
    if (row.assessment.quality == Quality::Ok) {
      EXPECT_LT(error_rad(row.axis_icrf, motion.axis_icrf).norm(), kSigmas * sigma_rad(row))
          << sentence_of(row.assessment);
    }
  }
}

TEST(SpinSequentialNutation, DoesNotMoveTheAxis) {
  constexpr int kPasses = 40;
  WobblingPasses passes{2403, 300.0};
  double squares = 0.0;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    truth.motion.nutation = passes.random_nutation(pass % 2 == 0 ? 0.2 * kRadPerDeg : kRadPerDeg);
    const SpinOutput output = run(SpinPass{passes.config(), passes.orbit()}, passes.pulses(truth));
    const SpinEstimate last = last_estimate(output, SpinEstimator::Sequential);
    SCOPED_TRACE(std::to_string(pass) + ": " + sentence_of(last.assessment));
    const double square = squared_error(last, truth.motion.axis_icrf);
    EXPECT_LT(square, kSigmas * kSigmas);
    squares += square;
    expect_no_wrong_row_is_ok(output, truth.motion);
  }
  RecordProperty("squares", std::to_string(squares));
  // Nutation averages out faster than the noise it is taken for, so only the upper 99 % limit of
  // chi-square with 80 degrees of freedom applies.
  EXPECT_LT(squares, 112.3);
}

}  // namespace spindrift::testing::spin_sequential_nutation_test
