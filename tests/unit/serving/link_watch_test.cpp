#include "services/serving/link_watch.h"

#include "tests/support/matchers.h"

namespace spindrift::link_watch_test {

constexpr LinkWatch::Instant kCame{std::chrono::hours{7}};
const TaiTime kT = tai_from_ns(1'795'143'637'000'000'000);

TEST(LinkWatch, WaitsForWhatHasNotComeYet) {
  const LinkWatch links{{"SPINNER"}};
  const auto report = links.report(kCame);
  ASSERT_EQ(report.size(), 1U);
  EXPECT_EQ(report[0].spacecraft, "SPINNER");
  EXPECT_EQ(report[0].link, LinkState::Waiting);
  EXPECT_FALSE(report[0].last_sample);
  EXPECT_FALSE(report[0].data_age_s);
}

TEST(LinkWatch, IsStaleAfterSilenceAndLiveAgainWithTheNextSample) {
  LinkWatch links{{"SPINNER", "SILENT"}};
  links.hear("SPINNER", kT, kCame);

  const auto last_instant = kCame + LinkWatch::kStaleAfter;
  const auto live = links.report(last_instant).at(1);
  EXPECT_EQ(live.link, LinkState::Live);
  EXPECT_EQ(live.last_sample, kT);
  EXPECT_EQ(live.data_age_s, 5.0);

  const auto later = last_instant + std::chrono::milliseconds{1};
  EXPECT_EQ(links.report(later).at(1).link, LinkState::Stale);
  EXPECT_EQ(links.report(later).at(0).link, LinkState::Waiting);

  links.hear("SPINNER", kT + std::chrono::seconds{5}, later);
  EXPECT_EQ(links.report(later).at(1).link, LinkState::Live);
}

TEST(LinkWatch, IsStaleAfterARestartUntilTheNextSample) {
  LinkWatch links{{"SPINNER"}};
  links.go_on("SPINNER", kT, kCame);
  const auto stored = links.report(kCame).at(0);
  EXPECT_EQ(stored.link, LinkState::Stale);
  EXPECT_EQ(stored.last_sample, kT);
  EXPECT_FALSE(stored.data_age_s);
  links.hear("SPINNER", kT, kCame);
  EXPECT_EQ(links.report(kCame).at(0).link, LinkState::Live);
}

TEST(LinkWatch, CountsNoSilenceWhileSendersMayWaitForTheReaderThatWasKilled) {
  LinkWatch links{{"SPINNER", "ANOTHER"}};
  links.go_on("SPINNER", kT, kCame);
  EXPECT_FALSE(links.silent_s("SPINNER", kCame));
  for (const std::string spacecraft : {"SPINNER", "ANOTHER"}) {
    links.hear(spacecraft, kT, kCame + std::chrono::seconds{1});
  }
  EXPECT_EQ(links.silent_s("SPINNER", kCame + kHeldBack), 0.0);
  EXPECT_EQ(links.silent_s("SPINNER", kCame + kHeldBack + std::chrono::seconds{5}), 5.0);
  EXPECT_EQ(links.silent_s("ANOTHER", kCame + std::chrono::seconds{6}), 5.0);
}

TEST(LinkWatch, DoesNotLookAtOtherSpacecraft) {
  LinkWatch links{{"SPINNER"}};
  links.hear("OTHER", kT, kCame);
  EXPECT_EQ(links.report(kCame).size(), 1U);
}

}  // namespace spindrift::link_watch_test
