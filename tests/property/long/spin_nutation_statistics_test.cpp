/// Consistency of sigmas and false-alarm probabilities of the nutation search over many trials; the
/// single cases are in spin_nutation_test.cpp.

#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "tests/support/nutation_trials.h"

namespace spindrift::testing::spin_nutation_statistics_test {

TEST(SpinNutationStatistics, PeriodHalfAngleAndLeanAreWithinTheirSigmas) {
  constexpr int kTrials = 200;
  NutationTrials trials{11};
  double half_angle = 0.0;
  double period = 0.0;
  double lean = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const Nutation nutation = trials.random_nutation(0.2);
    SCOPED_TRACE(text_of(nutation));
    const Deviations off = deviations(trials.found(nutation), nutation);
    EXPECT_LT(off.period_share, 0.01);
    half_angle += std::pow(off.half_angle_sigmas, 2);
    period += std::pow(off.period_sigmas, 2);
    lean += std::pow(off.lean_sigmas, 2);
  }
  // The 99.9 % band of chi-square with 200 degrees of freedom over 200: 1 -+ 3.29 sqrt(2 / 200).
  for (const double sum : {half_angle, period, lean}) {
    EXPECT_NEAR(sum / kTrials, 1.0, 0.33);
  }
}

TEST(SpinNutationStatistics, NoiseAloneShowsNoneAndItsChancesAreAsStated) {
  constexpr int kTrials = 400;
  NutationTrials trials{12};
  int at_most_a_tenth = 0;
  for (int i = 0; i < kTrials; ++i) {
    const auto search = trials.searched({});
    EXPECT_FALSE(search.found);
    at_most_a_tenth += search.false_alarm <= 0.1 ? 1 : 0;
  }
  // The stated probability is a bound, and a grid misses the peak slightly: at most 40 are
  // expected, with a standard deviation of 6.
  EXPECT_LT(at_most_a_tenth, 60);
  EXPECT_GT(at_most_a_tenth, 8);
}

TEST(SpinNutationStatistics, AtTheLimitOfDetection95Of100AreFound) {
  constexpr int kTrials = 200;
  NutationTrials trials{13};
  const double limit_deg = trials.searched({}).detectable_rad / kRadPerDeg;
  int found = 0;
  int found_at_half = 0;
  for (int i = 0; i < kTrials; ++i) {
    found += trials.searched(trials.random_nutation(limit_deg)).found ? 1 : 0;
    found_at_half += trials.searched(trials.random_nutation(0.5 * limit_deg)).found ? 1 : 0;
  }
  // 190 are expected, with a standard deviation of 3.
  EXPECT_GT(found, 180);
  EXPECT_LT(found_at_half, 40);
}

}  // namespace spindrift::testing::spin_nutation_statistics_test
