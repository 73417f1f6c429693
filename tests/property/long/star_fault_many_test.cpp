#include <gtest/gtest.h>

#include "tests/support/star_fault.h"

namespace spindrift::testing::star_fault_many_test {

TEST(StarFaultMany, MakesNoWrongAttitudeOk) { expect_honest_rows(60); }

}  // namespace spindrift::testing::star_fault_many_test
