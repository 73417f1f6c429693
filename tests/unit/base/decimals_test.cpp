#include "services/base/decimals.h"

#include <limits>

#include "tests/support/matchers.h"

namespace spindrift::decimals_test {

TEST(Decimals, ShowTwoDigitsOfSigma) {
  EXPECT_EQ(decimals_for(0.0417, 2), 3);
  EXPECT_EQ(decimals_for(3.8e-6, 4), 7);
  EXPECT_EQ(decimals_for(12.0, 4), 0);
  EXPECT_EQ(with_sigma(100.14221, 4.17e-5, 4), "100.142210 +/- 0.000042");
  EXPECT_EQ(to_its_digits(2.5e-7, 4), "0.00000025");
}

TEST(Decimals, AreTheUsualOnesWhereSigmaSaysNothing) {
  EXPECT_EQ(decimals_for(0.0, 4), 4);
  EXPECT_EQ(decimals_for(std::numeric_limits<double>::infinity(), 4), 4);
  EXPECT_EQ(decimals_for(1e-300, 4), 12);
}

TEST(Decimals, ASignStandsBeforeEveryValue) {
  EXPECT_EQ(signed_with_sigma(0.25, 0.1, 2), "+0.25 +/- 0.10");
  EXPECT_EQ(signed_with_sigma(-0.25, 0.1, 2), "-0.25 +/- 0.10");
}

}  // namespace spindrift::decimals_test
