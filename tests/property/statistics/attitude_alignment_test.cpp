#include <gtest/gtest.h>

#include "tests/support/misaligned_pass.h"

namespace spindrift::testing::attitude_alignment_test {

TEST(AttitudeAlignmentStatistics, SigmaHoldsWhereTheMissionFileIsOffAsStated) {
  expect_sigma_that_holds(30);
}

}  // namespace spindrift::testing::attitude_alignment_test
