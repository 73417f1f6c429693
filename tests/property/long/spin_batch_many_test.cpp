#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/batch_statistics.h"

namespace spindrift::testing::spin_batch_many_test {

constexpr int kPasses = 2000;

void expect_at_the_bound(const BatchStatistics& sums) {
  EXPECT_EQ(sums.failures, 0);
  // The 95 % band of chi-square with 4000 degrees of freedom.
  EXPECT_GT(sums.squares, 3826.6);
  EXPECT_LT(sums.squares, 4177.1);
  // The limit is three standard deviations above the bound.
  EXPECT_LT(sums.rms_over_bound(), 1.05);
  EXPECT_LT(sums.rms_noise(), 0.05 / 3.0);
  ::testing::Test::RecordProperty("squares", std::to_string(sums.squares));
  ::testing::Test::RecordProperty("rms over bound", std::to_string(sums.rms_over_bound()));
}

const BiasSet kThreeBiases =
    BiasSet{}.set(NorthChordBias).set(SouthMountAngleBias).set(DihedralBias);

TEST(SpinBatchMany, ReachTheBound) {
  expect_at_the_bound(many_passes(kPasses, {.turns = 100.0, .estimated = {}}, 2000));
}

TEST(SpinBatchMany, ReachTheBoundWithBiases) {
  expect_at_the_bound(many_passes(kPasses, {.turns = 100.0, .estimated = kThreeBiases}, 2001));
}

TEST(SpinBatchMany, ReachTheBoundWithAWideNorthChordThatIsRecovered) {
  const BatchStatistics sums = many_passes_with_a_wide_north_chord(kPasses, 2002);
  expect_at_the_bound(sums);
  // 3-sigma errors occur once in 370; more than 14 in 2000 have a probability of 1/2000.
  EXPECT_LE(sums.biases_beyond_three_sigmas, 14);
  EXPECT_GT(sums.biases, 1900);
}

TEST(SpinBatchMany, ErrorsOfTwoHundredAreThoseThatTheCovariancePromisesWithBiases) {
  const BatchStatistics sums = many_passes(200, {.turns = 60.0, .estimated = kThreeBiases}, 1801);
  EXPECT_EQ(sums.failures, 0);
  EXPECT_GT(sums.squares, 346.5);
  EXPECT_LT(sums.squares, 457.3);
  // Four sigma of the mean of chi-squares with one degree of freedom, correlated by the prior.
  ASSERT_GT(sums.biases, 100);
  EXPECT_NEAR(sums.bias_squares / sums.biases, 1.0, 4.0 * std::sqrt(2.0 / sums.biases));
}

TEST(SpinBatchMany, AWideNorthChordIsRecoveredInTwoHundredAndTheAxisIsAtTheBound) {
  const BatchStatistics sums = many_passes_with_a_wide_north_chord(200, 1803);
  EXPECT_EQ(sums.failures, 0);
  EXPECT_GT(sums.squares, 346.5);
  EXPECT_LT(sums.squares, 457.3);
  EXPECT_LT(sums.rms_over_bound(), 1.0 + 3.0 * sums.rms_noise());
  // No bias is reported unless the edges at least halve the prior's sigma.
  EXPECT_GT(sums.biases, 180);
  EXPECT_NEAR(sums.bias_squares / sums.biases, 1.0, 4.0 * std::sqrt(2.0 / sums.biases));
  // 3-sigma errors occur once in 370; more than 4 in 200 have a probability of 1/500.
  EXPECT_LE(sums.biases_beyond_three_sigmas, 4);
}

}  // namespace spindrift::testing::spin_batch_many_test
