/// For any geometry and number of fixes, no OK mean is wrong and none lies apart from its fixes.

#include <gtest/gtest.h>

#include "tests/support/every_mean.h"

namespace spindrift::spin_mean_every_row_test {

TEST(SpinMeanEveryRow, IsRightWhereItIsOkAndAmongItsFixes) {
  testing::check_passes_across_the_limb(3200U, 40);
}

}  // namespace spindrift::spin_mean_every_row_test
