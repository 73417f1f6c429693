#include <gtest/gtest.h>

#include "tests/support/star_fault.h"

namespace spindrift::star_fault_many_test {

TEST(StarFaultMany, MakesNoWrongAttitudeOk) { testing::expect_honest_rows(60); }

}  // namespace spindrift::star_fault_many_test
