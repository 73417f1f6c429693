/// Times truncated to 1 us, 0.1 ms and 1 ms at rates commensurate with these and not: every row of
/// `mean` and `sequential`, and `batch` along the pass.

#include <gtest/gtest.h>

#include "tests/support/times_on_grid.h"

namespace spindrift::testing::spin_time_grid_many_test {

class SpinTimeGridMany : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(SpinTimeGridMany, ErrorsAreInsideFourSigmasWhereItIsOk) {
  constexpr std::uint64_t kSeeds = 5;
  PassOnGrid all;
  int passes = 0;
  for (const double rpm : kRatesOnGrid_rpm) {
    for (std::uint64_t seed = 4310; seed < 4310 + kSeeds; ++seed) {
      SCOPED_TRACE(std::to_string(rpm) + " rpm, seed " + std::to_string(seed));
      const PassOnGrid found = pass_on_grid(rpm, GetParam(), seed, 300.0);
      for (const OnGrid& one : {found.mean, found.sequential, found.batch}) {
        EXPECT_LT(one.most_sigmas, 4.0);
      }
      all.mean += found.mean;
      all.sequential += found.sequential;
      all.batch += found.batch;
      ++passes;
    }
  }
  // The first thirty revolutions yield no OK row; after them most rows and solutions are OK.
  for (const OnGrid& one : {all.mean, all.sequential, all.batch}) {
    EXPECT_GT(2 * one.ok, one.rows);
  }
  EXPECT_EQ(passes, 100);
}

INSTANTIATE_TEST_SUITE_P(Grids, SpinTimeGridMany, ::testing::Values(1'000, 100'000, 1'000'000));

}  // namespace spindrift::testing::spin_time_grid_many_test
