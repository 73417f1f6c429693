/// Statistics of two hundred passes; the quick test takes forty.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/squared_errors.h"

namespace spindrift::spin_statistics_many_test {

TEST(SpinStatisticsMany, ErrorsOfTwoHundredPassesAreThoseThatTheirSigmasPromise) {
  const testing::SquaredErrors sums = testing::squared_errors_of(200, 122);
  RecordProperty("mean", std::to_string(sums.mean));
  RecordProperty("sequential", std::to_string(sums.sequential));
  RecordProperty("rate", std::to_string(sums.rate));
  RecordProperty("model_off", sums.model_off);
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

}  // namespace spindrift::spin_statistics_many_test
