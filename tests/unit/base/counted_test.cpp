#include "services/base/counted.h"

#include "tests/support/matchers.h"

namespace spindrift::counted_test {

TEST(Counted, HasOneOfAThingWithoutItsPlural) {
  EXPECT_EQ(counted(1, "star fixes"), "1 star fix");
  EXPECT_EQ(counted(1, "gyro samples"), "1 gyro sample");
  EXPECT_EQ(counted(1, "edges"), "1 edge");
  EXPECT_EQ(counted(0, "bad rows"), "0 bad rows");
  EXPECT_EQ(counted(21, "star fixes"), "21 star fixes");
}

}  // namespace spindrift::counted_test
