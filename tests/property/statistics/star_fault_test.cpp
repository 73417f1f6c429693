/// A star tracker that is stuck or turned for a while does not make a wrong attitude OK; some
/// passes of what property/long repeats.

#include "tests/support/star_fault.h"

#include <gtest/gtest.h>

namespace spindrift::star_fault_test {

TEST(StarFault, MakesNoWrongAttitudeOk) { testing::expect_honest_rows(2); }

}  // namespace spindrift::star_fault_test
