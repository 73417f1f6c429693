#include <gtest/gtest.h>

#include "tests/support/every_mean.h"

namespace spindrift::spin_mean_every_row_many_test {

TEST(SpinMeanEveryRowMany, IsRightWhereItIsOkAndAmongItsFixes) {
  testing::check_passes_across_the_limb(3400U, 400);
}

}  // namespace spindrift::spin_mean_every_row_many_test
