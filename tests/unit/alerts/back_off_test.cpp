#include "services/alerts/back_off.h"

#include "tests/support/matchers.h"

namespace spindrift::back_off_test {

BackOff::Instant at(double t_s) {
  return BackOff::Instant{std::chrono::milliseconds{static_cast<int>(1000.0 * t_s)}};
}

TEST(BackOff, TriesAgainAfterTwiceAsLongEachTimeAndAtLastOnceAMinute) {
  BackOff tries;
  double t_s = 100.0;
  for (const double wait_s : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0, 60.0}) {
    ASSERT_TRUE(tries.is_due(at(t_s)));
    tries.fail(at(t_s));
    EXPECT_FALSE(tries.is_due(at(t_s + wait_s - 0.1)));
    t_s += wait_s;
  }
  EXPECT_EQ(tries.failures(), 8);
  EXPECT_EQ(tries.failing_s(at(t_s)), t_s - 100.0);
}

TEST(BackOff, BeginsAnewAfterASuccess) {
  BackOff tries;
  tries.fail(at(0.0));
  tries.fail(at(1.0));
  tries.succeed();
  EXPECT_EQ(tries.failing_s(at(2.0)), 0.0);
  EXPECT_TRUE(tries.is_due(at(2.0)));
  tries.fail(at(2.0));
  EXPECT_TRUE(tries.is_due(at(3.0)));
  EXPECT_EQ(tries.failures(), 3);
}

}  // namespace spindrift::back_off_test
