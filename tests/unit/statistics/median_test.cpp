#include "pipelines/statistics/median.h"

#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::median_test {

TEST(Median, IsTheUpperOfTwo) {
  std::vector<double> odd{3.0, 1.0, 2.0};
  std::vector<double> even{4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(upper_median(odd), 2.0);
  EXPECT_EQ(upper_median(even), 3.0);
}

TEST(Median, IsZeroForNoValues) { EXPECT_EQ(upper_median({}), 0.0); }

TEST(Median, AnyPlaceInTheOrderIsFound) {
  for (std::size_t n = 0; n < 5; ++n) {
    std::vector<double> values{4.0, 0.0, 3.0, 1.0, 2.0};
    EXPECT_EQ(in_order_at(values, n), static_cast<double>(n));
  }
}

}  // namespace spindrift::median_test
