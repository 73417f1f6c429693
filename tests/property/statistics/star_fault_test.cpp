#include "tests/support/star_fault.h"

#include <gtest/gtest.h>

namespace spindrift::testing::star_fault_test {

TEST(StarFault, MakesNoWrongAttitudeOk) { expect_honest_rows(2); }

}  // namespace spindrift::testing::star_fault_test
