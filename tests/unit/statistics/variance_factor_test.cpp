#include <limits>

#include "pipelines/statistics/significance.h"
#include "tests/support/matchers.h"

namespace spindrift::variance_factor_test {

// The mean square of 50 degrees of freedom has a standard deviation of 0.2.
TEST(VarianceFactor, IsOneUpToFiveSigmasOfTheMeanSquareAndItBeyond) {
  for (const double as_stated : {0.0, 0.4, 1.0, 1.999}) {
    EXPECT_EQ(variance_factor(as_stated, 50.0), 1.0);
  }
  EXPECT_EQ(variance_factor(2.001, 50.0), 2.001);
  EXPECT_EQ(variance_factor(100.0, 50.0), 100.0);
}

TEST(VarianceFactor, NeedsLessExcessTheMoreDegreesOfFreedomThereAre) {
  EXPECT_EQ(variance_factor(1.1, 4'000.0), 1.0);
  EXPECT_EQ(variance_factor(1.1, 6'000.0), 1.1);
}

TEST(VarianceFactor, IsOneOfWhatIsNoNumber) {
  EXPECT_EQ(variance_factor(std::numeric_limits<double>::quiet_NaN(), 50.0), 1.0);
}

TEST(VarianceFactor, OfASumOfSquaresIsTestedAlike) {
  EXPECT_TRUE(noise_is_as_stated(0.0, 50.0));
  EXPECT_TRUE(noise_is_as_stated(50.0 * 1.999, 50.0));
  EXPECT_FALSE(noise_is_as_stated(50.0 * 2.001, 50.0));
}

}  // namespace spindrift::variance_factor_test
