/// For any geometry and number of fixes, no OK mean is wrong and none lies apart from its fixes.

#include <gtest/gtest.h>

#include "tests/support/every_mean.h"

namespace spindrift::testing::spin_mean_every_row_test {

TEST(SpinMeanEveryRow, IsRightWhereItIsOkAndAmongItsFixes) {
  check_passes_across_the_limb(3200U, 40);
}

TEST(SpinMeanEveryRowMany, IsRightWhereItIsOkAndAmongItsFixes) {
  check_passes_across_the_limb(3400U, 400);
}

}  // namespace spindrift::testing::spin_mean_every_row_test
