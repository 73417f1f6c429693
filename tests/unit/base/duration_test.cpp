#include "services/base/duration.h"

#include "tests/support/matchers.h"

namespace spindrift::duration_test {

TEST(Duration, IsSaidInTwoUnitsAtMost) {
  EXPECT_EQ(duration_text(0.0), "0 s");
  EXPECT_EQ(duration_text(0.4), "0.4 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(60.0), "1 min");
  EXPECT_EQ(duration_text(725.0), "12 min 5 s");
  EXPECT_EQ(duration_text(19'200.0), "5 h 20 min");
  EXPECT_EQ(duration_text(86'400.0), "1 day");
  EXPECT_EQ(duration_text(475'831.988), "5 days 12 h");
}

TEST(Duration, RoundsUpIntoTheLargerUnit) {
  EXPECT_EQ(duration_text(59.6), "1 min");
  EXPECT_EQ(duration_text(3599.7), "1 h");
  EXPECT_EQ(duration_text(86'385.0), "1 day");
}

}  // namespace spindrift::duration_test
