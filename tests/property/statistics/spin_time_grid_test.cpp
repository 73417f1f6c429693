/// With times truncated to a grid, no OK estimate is beyond four sigmas. All rates and more passes
/// are in property/long.

#include <gtest/gtest.h>

#include "tests/support/times_on_grid.h"

namespace spindrift::testing::spin_time_grid_test {

TEST(SpinTimeGrid, ErrorsAreInsideFourSigmasWhereItIsOk) {
  for (const double rpm : {60.0, 59.9999, 99.2177}) {
    for (const std::int64_t grid_ns : {100'000, 1'000'000}) {
      SCOPED_TRACE(std::to_string(rpm) + " rpm, " + std::to_string(grid_ns) + " ns");
      const PassOnGrid found = pass_on_grid(rpm, grid_ns, 4301, 100.0);
      for (const OnGrid& one : {found.mean, found.sequential, found.batch}) {
        EXPECT_LT(one.most_sigmas, 4.0);
        EXPECT_GT(one.ok, 0);
      }
    }
  }
}

}  // namespace spindrift::testing::spin_time_grid_test
