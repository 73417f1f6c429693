/// Two thousand passes: `batch` reaches the Cramer-Rao bound, with biases and without.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/batch_statistics.h"

namespace spindrift {
namespace {

constexpr int kPasses = 2000;

void expect_at_the_bound(const testing::BatchStatistics& sums) {
  EXPECT_EQ(sums.failures, 0);
  // 95 % of chi-square, 4000 degrees of freedom.
  EXPECT_GT(sums.squares, 3826.6);
  EXPECT_LT(sums.squares, 4177.1);
  EXPECT_LT(std::sqrt(sums.error_rad2 / sums.bound_rad2), 1.05);
  ::testing::Test::RecordProperty("squares", std::to_string(sums.squares));
  ::testing::Test::RecordProperty("rms over bound",
                                  std::to_string(std::sqrt(sums.error_rad2 / sums.bound_rad2)));
}

TEST(SpinBatchMany, ReachTheBound) {
  expect_at_the_bound(testing::many_passes(kPasses, 100.0, {}, 2000));
}

TEST(SpinBatchMany, ReachTheBoundWithBiases) {
  const BiasSet estimated =
      BiasSet{}.set(NorthChordBias).set(SouthMountAngleBias).set(DihedralBias);
  expect_at_the_bound(testing::many_passes(kPasses, 100.0, estimated, 2001));
}

}  // namespace
}  // namespace spindrift
