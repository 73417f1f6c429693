#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/information_limit.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"
#include "tests/support/squared_errors.h"

namespace spindrift::testing::spin_statistics_test {

TEST(SpinStatistics, ErrorsOfFortyPassesAreThoseThatTheirSigmasPromise) {
  const SquaredErrors sums = squared_errors_of(40, 121);
  sums.record();
  // The 0.05 % and 99.95 % points of chi-square.
  for (const double sum : {sums.mean, sums.sequential}) {  // 80 degrees of freedom.
    EXPECT_GT(sum, 44.79);
    EXPECT_LT(sum, 128.26);
  }
  // The sigma of the rate allows for a wandering rate, which these passes do not have: it may be up
  // to three times the actual errors but never below. 40 degrees of freedom.
  EXPECT_GT(sums.rate, 40.0 / 9.0);
  EXPECT_LT(sums.rate, 76.09);
}

TEST(SpinStatisticsMany, ErrorsOfTwoHundredPassesAreThoseThatTheirSigmasPromise) {
  const SquaredErrors sums = squared_errors_of(200, 122);
  sums.record();
  // A false alarm occurs once in 10,000 checks, and a pass makes 150 correlated ones.
  EXPECT_LE(sums.model_off, 2);
  // The 2.5 % and 97.5 % points of chi-square.
  EXPECT_GT(sums.mean, 346.48);  // 400 degrees of freedom.
  EXPECT_LT(sums.mean, 457.31);
  EXPECT_GT(sums.sequential, 346.48);
  EXPECT_LT(sums.sequential, 457.31);
  // 200 degrees of freedom; the sigma may be three times the error.
  EXPECT_GT(sums.rate, 200.0 / 9.0);
  EXPECT_LT(sums.rate, 241.06);
}

TEST(SpinStatistics, SigmaOfWholePassesIsThatOfTheInformationLimit) {
  const Surroundings from;
  std::mt19937_64 rng{123};
  for (int pass = 0; pass < 8; ++pass) {
    SCOPED_TRACE(pass);
    const SpinningBody body = random_body(from.around, 4.0 * kRadPerDeg, rng);
    const double duration_s = body.seconds_of(kStatisticsRevolutions);
    const SpinOutput output =
        run(SpinPass{body.config, from.orbit}, from.pulses(body, 0.0, duration_s, rng));
    const double limit_rad = std::sqrt(cramer_rao_rad2(body, from.around, duration_s).trace());
    const double sequential_rad = sigma_rad(last_estimate(output, SpinEstimator::Sequential));
    EXPECT_NEAR(sequential_rad / limit_rad, 1.0, 0.05);
  }
}

}  // namespace spindrift::testing::spin_statistics_test
