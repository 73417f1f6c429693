#include <gtest/gtest.h>

#include "tests/support/misaligned_pass.h"

namespace spindrift::testing::attitude_alignment_many_test {

TEST(AttitudeAlignmentMany, SigmaHoldsWhereTheMissionFileIsOffAsStated) {
  expect_sigma_that_holds(200);
}

}  // namespace spindrift::testing::attitude_alignment_many_test
