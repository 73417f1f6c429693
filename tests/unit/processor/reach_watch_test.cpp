#include "services/processor/reach_watch.h"

#include "tests/support/matchers.h"

namespace spindrift::reach_watch_test {

using namespace std::chrono_literals;

constexpr TaiTime kT = tai_from_ns(1'795'143'637'000'000'000);

void see(ReachWatch& watch, TaiTime t) {
  watch.include(t);
  watch.carry_on(t);
}

TEST(ReachWatch, TellsAnEarlierBeginningAtOnceAndALaterEndOnceAMinute) {
  ReachWatch watch{std::nullopt};
  EXPECT_FALSE(watch.take_news());
  see(watch, kT);
  EXPECT_EQ(watch.take_news().value().last, kT);
  see(watch, kT + 59s);
  EXPECT_FALSE(watch.take_news());
  watch.include(kT - 1s);
  EXPECT_EQ(watch.take_news().value().first, kT - 1s);
  see(watch, kT + 119s);
  EXPECT_EQ(watch.take_news().value().last, kT + 119s);
  see(watch, kT + 120s);
  EXPECT_FALSE(watch.take_news());
  EXPECT_EQ(watch.take_last().value().last, kT + 120s);
}

TEST(ReachWatch, DoesNotEndWithATimeToWhichThePassHasNotCome) {
  ReachWatch watch{std::nullopt};
  see(watch, kT);
  watch.include(kT + 10'000h);
  EXPECT_EQ(watch.take_last().value().last, kT);
}

TEST(ReachWatch, CountsTheSpansOfTheContactInWhichSamplesCame) {
  ReachWatch watch{Contact{.from = kT, .to = kT + 95s}};
  for (const auto t : {-5s, 1s, 2s, 31s, 94s, 95s, 500s}) {
    see(watch, kT + t);
  }
  EXPECT_DOUBLE_EQ(watch.take_last().value().contact_share.value(), 0.3);
  ReachWatch unplanned{std::nullopt};
  see(unplanned, kT);
  EXPECT_FALSE(unplanned.take_last().value().contact_share);
}

TEST(ReachWatch, CountsSilencesAndKnowsTheLongest) {
  ReachWatch watch{std::nullopt};
  for (const auto t : {0s, 300s, 1000s, 900s, 1301s, 1302s}) {
    see(watch, kT + t);
  }
  EXPECT_EQ(watch.silences().count, 2);
  EXPECT_EQ(watch.silences().longest_from, kT + 300s);
  EXPECT_EQ(watch.silences().longest_to, kT + 1000s);
}

}  // namespace spindrift::reach_watch_test
