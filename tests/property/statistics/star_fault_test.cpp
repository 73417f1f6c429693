#include "tests/support/star_fault.h"

#include <gtest/gtest.h>

namespace spindrift::star_fault_test {

TEST(StarFault, MakesNoWrongAttitudeOk) { testing::expect_honest_rows(2); }

}  // namespace spindrift::star_fault_test
