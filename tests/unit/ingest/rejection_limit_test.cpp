#include "services/ingest/rejection_limit.h"

#include <chrono>

#include "tests/support/matchers.h"

namespace spindrift::rejection_limit_test {

using namespace std::chrono_literals;

// 2026-11-20T03:00:00 UTC.
constexpr TaiTime kNow = tai_from_ns(1'795'143'637'000'000'000);

RejectedInput impossible(std::int64_t seq, const std::string& source = "front-end") {
  return {.source = source, .line = seq, .reason = "t_tai_ns = -1", .session = 5};
}

/// Returns how many of `count` rejections are kept.
int kept_of(RejectionLimit& limit, int count, TaiTime now) {
  int kept = 0;
  for (int seq = 0; seq < count; ++seq) {
    kept += limit.pass(impossible(seq), now) ? 1 : 0;
  }
  return kept;
}

TEST(RejectionLimit, KeepsTheFirstOfAMinuteAndTheNumberOfTheRest) {
  RejectionLimit limit;
  EXPECT_EQ(kept_of(limit, 1000, kNow), RejectionLimit::kKept);
  EXPECT_TRUE(limit.take_rest(kNow + 59s).empty());
  const auto rest = limit.take_rest(kNow + 60s);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].source, "front-end");
  EXPECT_EQ(rest[0].session, 5U);
  EXPECT_EQ(rest[0].line, 999);
  EXPECT_EQ(rest[0].samples, 1000 - RejectionLimit::kKept);
  EXPECT_EQ(rest[0].reason,
            "980 more in the minute since 2026-11-20T03:00:00Z are only counted, the last: "
            "t_tai_ns = -1");
  EXPECT_TRUE(limit.take_rest(kNow + 61s).empty());
  EXPECT_EQ(kept_of(limit, 1000, kNow + 61s), RejectionLimit::kKept);
}

TEST(RejectionLimit, CountsEachSourceForItself) {
  RejectionLimit limit;
  EXPECT_EQ(kept_of(limit, 1000, kNow), RejectionLimit::kKept);
  EXPECT_TRUE(limit.pass(impossible(0, "other"), kNow));
  EXPECT_EQ(limit.take_rest(TaiTime::max()).size(), 1U);
}

TEST(RejectionLimit, GivesTheRestWhenTheClockIsSetBack) {
  RejectionLimit limit;
  kept_of(limit, 1000, kNow);
  EXPECT_EQ(limit.take_rest(kNow - 1h).size(), 1U);
}

TEST(RejectionLimit, IsBoundedWhateverSourcesAreNamed) {
  RejectionLimit limit;
  std::int64_t kept = 0;
  constexpr std::int64_t kSent = 100'000;
  for (std::int64_t seq = 0; seq < kSent; ++seq) {
    kept += limit.pass(impossible(seq, "source " + std::to_string(seq)), kNow) ? 1 : 0;
  }
  EXPECT_EQ(kept, RejectionLimit::kMaxSources + RejectionLimit::kKept);
  const auto rest = limit.take_rest(TaiTime::max());
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].source, "(other sources)");
  EXPECT_EQ(rest[0].samples + kept, kSent);
}

}  // namespace spindrift::rejection_limit_test
