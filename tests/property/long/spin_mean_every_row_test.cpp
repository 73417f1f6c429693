/// Whatever the geometry, and however few the fixes: no mean that is published as OK is wrong, and
/// none lies apart from its fixes.

#include <gtest/gtest.h>

#include "tests/support/every_mean.h"

namespace spindrift::spin_mean_every_row_test {

TEST(SpinMeanEveryRow, IsRightWhereItIsOkAndAmongItsFixes) {
  testing::check_passes_across_the_limb(3200U, 40);
}

}  // namespace spindrift::spin_mean_every_row_test
