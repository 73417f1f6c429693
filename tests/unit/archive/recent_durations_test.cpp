#include "services/archive/recent_durations.h"

#include "tests/support/matchers.h"

namespace spindrift::recent_durations_test {

TEST(RecentDurations, P99IsTheSmallestThatNinetyNinePercentDoNotExceed) {
  RecentDurations durations{1000};
  EXPECT_FALSE(durations.percentile_ms(99));
  for (int i = 1; i <= 200; ++i) {
    durations.add(i);
  }
  EXPECT_EQ(durations.percentile_ms(99), 198.0);
}

TEST(RecentDurations, OldestAreForgottenFirst) {
  RecentDurations durations{2};
  for (const double duration_ms : {9.0, 1.0, 2.0}) {
    durations.add(duration_ms);
  }
  EXPECT_EQ(durations.percentile_ms(99), 2.0);
}

}  // namespace spindrift::recent_durations_test
