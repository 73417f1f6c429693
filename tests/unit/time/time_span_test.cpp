#include "pipelines/time/time_span.h"

#include <limits>

#include "tests/support/matchers.h"

namespace spindrift::time_span_test {

constexpr std::int64_t kFirst_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast_ns = std::numeric_limits<std::int64_t>::max();

TEST(TimeSpan, IsTheDifferenceOrTheLongestThereIs) {
  EXPECT_EQ(span_between(tai_from_ns(3), tai_from_ns(10)).count(), 7);
  EXPECT_EQ(span_between(tai_from_ns(10), tai_from_ns(3)).count(), -7);
  EXPECT_EQ(span_between(tai_from_ns(kFirst_ns), tai_from_ns(kLast_ns)).count(), kLast_ns);
  EXPECT_EQ(span_between(tai_from_ns(kLast_ns), tai_from_ns(kFirst_ns)).count(), kFirst_ns);
  EXPECT_EQ(elapsed_s(tai_from_ns(0), tai_from_ns(1'500'000'000)), 1.5);
}

TEST(TimeSpan, AddsUpToTheLastInstantThereIs) {
  EXPECT_EQ(tai_ns(later_by(tai_from_ns(3), std::chrono::nanoseconds{7})), 10);
  EXPECT_EQ(tai_ns(later_by(tai_from_ns(kLast_ns - 1), std::chrono::nanoseconds{7})), kLast_ns);
  EXPECT_EQ(tai_ns(later_by(tai_from_ns(kFirst_ns + 1), std::chrono::nanoseconds{-7})), kFirst_ns);
  EXPECT_EQ(tai_ns(later_by_s(tai_from_ns(5), 2.5)), 2'500'000'005);
  EXPECT_EQ(tai_ns(later_by_s(tai_from_ns(kLast_ns - 1), 1e300)), kLast_ns);
  EXPECT_EQ(tai_ns(later_by_s(tai_from_ns(kFirst_ns + 1), -1e300)), kFirst_ns);
}

}  // namespace spindrift::time_span_test
