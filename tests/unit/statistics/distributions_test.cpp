#include "pipelines/statistics/distributions.h"

#include <cmath>

#include "pipelines/statistics/significance.h"
#include "tests/support/matchers.h"

namespace spindrift::distributions_test {

TEST(Normal, IsExceededByTheChancesOfThePublishedTables) {
  // Abramowitz and Stegun, table 26.5.
  EXPECT_NEAR(normal_beyond(0.05), 1.64485, 5e-6);
  EXPECT_NEAR(normal_beyond(0.001), 3.09023, 5e-6);
  EXPECT_NEAR(normal_beyond(1e-4), 3.71902, 5e-6);
  EXPECT_NEAR(normal_beyond(0.5), 0.0, 1e-12);
  for (const double chance : {1e-9, 1e-4, 0.2, 0.9}) {
    EXPECT_NEAR(0.5 * std::erfc(normal_beyond(chance) / std::sqrt(2.0)) / chance, 1.0, 1e-12);
  }
}

TEST(ChiSquare, IsExceededByTheChanceOfTheClosedFormForOneAndTwoDegrees) {
  for (const double chance : {1e-9, 1.2e-5, 0.1, 0.7}) {
    EXPECT_NEAR(chi_square_beyond(chance, 2.0) / (-2.0 * std::log(chance)), 1.0, 1e-12);
    const double sigmas = normal_beyond(0.5 * chance);
    EXPECT_NEAR(chi_square_beyond(chance, 1.0) / (sigmas * sigmas), 1.0, 1e-12);
  }
}

TEST(ChiSquare, IsExceededByTheChancesOfThePublishedTables) {
  // Abramowitz and Stegun, table 26.8.
  EXPECT_NEAR(chi_square_beyond(0.05, 10.0), 18.3070, 5e-5);
  EXPECT_NEAR(chi_square_beyond(0.01, 30.0), 50.8922, 5e-5);
  EXPECT_NEAR(chi_square_tail(18.3070, 10.0), 0.05, 1e-6);
  EXPECT_EQ(chi_square_tail(0.0, 3.0), 1.0);
}

TEST(Significance, NumbersWithFewerDigitsAreThoseOfTheNormalDistribution) {
  EXPECT_NEAR(kDetectionSigmas, normal_beyond(0.05), 2e-4);
  EXPECT_NEAR(kFalseAlarmSquares, chi_square_beyond(kFalseAlarm, 2.0), 1e-3);
  EXPECT_NEAR(kMedianDeviation, normal_beyond(0.25), 2e-5);
  EXPECT_NEAR(kSigmaPerMad, 1.0 / normal_beyond(0.25), 1e-14);
}

TEST(VarianceRatio, TailIsThatOfThePublishedTables) {
  // Upper points of F: Abramowitz and Stegun, table 26.9.
  struct Entry {
    double freedom_above;
    double freedom_below;
    double level;
    double ratio;
  };
  for (const Entry& entry :
       {Entry{2, 2, 0.01, 99.00}, Entry{10, 10, 0.05, 2.98}, Entry{10, 10, 0.01, 4.85},
        Entry{4, 20, 0.05, 2.87}, Entry{20, 20, 0.05, 2.12}, Entry{20, 10, 0.01, 4.41},
        Entry{120, 120, 0.05, 1.35}, Entry{120, 120, 0.01, 1.53}}) {
    // Half a unit of the last digit printed.
    EXPECT_GE(variance_ratio_tail(entry.freedom_above, entry.freedom_below, entry.ratio - 0.005),
              entry.level);
    EXPECT_LE(variance_ratio_tail(entry.freedom_above, entry.freedom_below, entry.ratio + 0.005),
              entry.level);
  }
}

TEST(VarianceRatio, TailIsThatOfTheClosedFormForTwoDegreesAbove) {
  for (const int b : {1, 2, 10, 99}) {
    for (const double ratio : {0.1, 1.0, 3.0, 30.0}) {
      const double expected = std::pow(1.0 + ratio / b, -b);
      EXPECT_NEAR(variance_ratio_tail(2.0, 2.0 * b, ratio) / expected, 1.0, 1e-11);
    }
  }
  EXPECT_EQ(variance_ratio_tail(6.0, 8.0, 0.0), 1.0);
}

TEST(VarianceRatio, TailsOfARatioAndItsInverseAddUpToOne) {
  for (const double ratio : {0.5, 0.9, 1.7}) {
    EXPECT_NEAR(
        variance_ratio_tail(198.0, 84.0, ratio) + variance_ratio_tail(84.0, 198.0, 1.0 / ratio),
        1.0, 1e-12);
  }
}

}  // namespace spindrift::distributions_test
