#include "services/serving/service_watch.h"
#include "tests/support/matchers.h"

namespace spindrift::backlog_watch_test {

BacklogWatch::Instant at(int t_s) { return BacklogWatch::Instant{std::chrono::seconds{t_s}}; }

TEST(BacklogWatch, GivesTheAgeOfTheOldestSampleThatIsNotCommitted) {
  BacklogWatch backlog;
  EXPECT_EQ(backlog.update(at(0), 0, 0), 0.0);
  EXPECT_EQ(backlog.update(at(1), 10, 5), 0.0);
  EXPECT_EQ(backlog.update(at(2), 20, 10), 0.0);
  EXPECT_EQ(backlog.update(at(5), 20, 10), 3.0);
  EXPECT_EQ(backlog.update(at(6), 30, 19), 4.0);
  EXPECT_EQ(backlog.update(at(7), 30, 20), 1.0);
  EXPECT_EQ(backlog.update(at(8), 30, 30), 0.0);
}

}  // namespace spindrift::backlog_watch_test
