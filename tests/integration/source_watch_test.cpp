#include "services/processor/source_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/processor/steady_time.h"

namespace spindrift::source_watch_test {

using namespace std::chrono_literals;
using Verdict = SourceWatch::Verdict;

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr std::size_t kEnough = PassWatch::kEnoughToAccept;

class SourceWatchTest : public ::testing::Test {
 protected:
  static constexpr SourceLimits kByClock{.within = 60s, .silence = 60s};

  explicit SourceWatchTest(const SourceLimits& limits = kReplayLimits) : watch_{kByClock, limits} {}

  Verdict see(const std::string& source, TaiTime t, std::uint64_t session = 1) {
    return watch_.admit(
        {.source = source, .session = session, .seq = 0},
        Arrived<Pulse>{.arrival = {++arrival_}, .value = {.t = t, .channel = PulseChannel::Sun1}},
        moment_);
  }

  /// Passes `count` samples, one a second.
  /// @return Verdict on the last one.
  Verdict see_some(const std::string& source, TaiTime first, std::size_t count = kEnough) {
    Verdict last = Verdict::InTime;
    for (std::size_t i = 0; i < count; ++i) {
      last = see(source, first + i * 1s);
    }
    return last;
  }

  std::string successor() const {
    const auto found = watch_.successor(moment_);
    return found ? found->name : "";
  }

  SourceWatch watch_;
  Moment moment_;
  std::int64_t arrival_ = 0;
};

TEST(SteadyTime, IsWhereEightInARowAreWhateverSingleOnesSay) {
  SteadyTime time;
  for (std::size_t i = 0; i + 1 < kEnough; ++i) {
    time.advance_to(kStart + i * 1s);
    EXPECT_FALSE(time.time());
  }
  time.advance_to(kStart + 8s);
  EXPECT_EQ(time.time(), kStart + 8s);
  time.advance_to(kStart + 2h);
  EXPECT_EQ(time.time(), kStart + 8s);
  time.advance_to(kStart + 9s);
  EXPECT_EQ(time.time(), kStart + 9s);
  EXPECT_FALSE(time.goes_on());
  for (std::size_t i = 0; i < 2 * kEnough; ++i) {
    time.advance_to(kStart - 2h);
  }
  EXPECT_EQ(time.time(), kStart + 9s) << "the same one again and again";
  for (std::size_t i = 0; i < kEnough; ++i) {
    time.advance_to(kStart - 1h + i * 1s);
  }
  EXPECT_EQ(time.time(), kStart - 1h + 7s);
}

TEST_F(SourceWatchTest, ALoneSourceIsInTimeWhereverItJumpsAhead) {
  EXPECT_EQ(see("one", kStart + 1h), Verdict::InTime);
  EXPECT_EQ(see_some("one", kStart, 20), Verdict::InTime);
  EXPECT_EQ(see("one", kStart + 1h), Verdict::InTime);
  EXPECT_EQ(see("one", kStart + 20s), Verdict::InTime);
  EXPECT_EQ(see_some("one", kStart + 3h), Verdict::InTime);
  EXPECT_EQ(watch_.pass_time(), kStart + 3h + 7s);
  EXPECT_TRUE(watch_.take_news().empty());
}

TEST_F(SourceWatchTest, OneThatDisagreesIsApartSampleBySampleUntilItHeals) {
  see_some("right", kStart);
  EXPECT_EQ(see("other", kStart + 8s), Verdict::InTime);
  EXPECT_EQ(see("other", kStart + 11min), Verdict::Apart);
  EXPECT_EQ(see("other", kStart + 9s), Verdict::Healed);
  EXPECT_EQ(count_of(watch_.take_held({.name = "other", .session = 1})), 0U);
  EXPECT_EQ(see("other", kStart - 10min), Verdict::Apart) << "607 s behind";
  EXPECT_EQ(see_some("other", kStart + 10s), Verdict::Healed);
  EXPECT_EQ(count_of(watch_.take_held({.name = "other", .session = 1})), 1U);
  const auto news = watch_.take_news();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].source.name, "other");
  EXPECT_EQ(news[0].t, kStart + 11min);
  EXPECT_EQ(news[0].clock, kStart + 7s);
  EXPECT_TRUE(news[1].healed);
  EXPECT_EQ(successor(), "");
}

TEST_F(SourceWatchTest, InAReplayOneThatGoesOnFasterThanTheOthersIsInTimeAndSoAreThey) {
  see_some("slow", kStart);
  EXPECT_EQ(see_some("fast", kStart, 600), Verdict::InTime);
  EXPECT_EQ(see("slow", kStart + 8s), Verdict::InTime);
}

TEST_F(SourceWatchTest, OneOfTwoThatBeganTogetherIsApart) {
  Verdict last = Verdict::InTime;
  for (std::size_t i = 0; i < 2 * kEnough; ++i) {
    EXPECT_EQ(see("one", kStart + i * 1s), Verdict::InTime);
    last = see("two", kStart + 2h + i * 1s);
  }
  EXPECT_EQ(last, Verdict::Apart);
}

TEST_F(SourceWatchTest, OneAheadFollowsOnceTheOthersAreSilent) {
  see_some("first", kStart);
  see_some("second", kStart + 30min, kEnough - 1);
  moment_.now += kReplayLimits.silence;
  EXPECT_EQ(successor(), "");
  see("second", kStart + 30min + 7s);
  EXPECT_EQ(successor(), "second");
  EXPECT_EQ(count_of(watch_.follow({.name = "second", .session = 1}, moment_)), kEnough);
  EXPECT_EQ(watch_.leader().value().name, "second");
  EXPECT_EQ(watch_.pass_time(), kStart + 30min + 7s);
  EXPECT_EQ(see("first", kStart + 8s), Verdict::Apart);
  EXPECT_EQ(successor(), "");
}

TEST_F(SourceWatchTest, NobodyFollowsWhoIsHeardNoMoreWhileTheOthersAre) {
  see_some("first", kStart);
  see_some("second", kStart + 30min);
  see("first", kStart + 8s);
  moment_.now += 1min;
  EXPECT_EQ(successor(), "");
  EXPECT_FALSE(watch_.next_decision());
  EXPECT_FALSE(watch_.successor_at_end(0));
}

TEST_F(SourceWatchTest, OneBehindFollowsOnceTheOthersAreSilent) {
  see_some("first", kStart + 2h);
  moment_.now += 1s;
  see_some("second", kStart);
  EXPECT_EQ(successor(), "");
  ASSERT_EQ(watch_.next_decision(), moment_.now - 1s + kReplayLimits.silence);
  EXPECT_FALSE(watch_.successor_at_end(kEnough));
  EXPECT_TRUE(watch_.successor_at_end(kEnough - 1));
  moment_.now = *watch_.next_decision();
  EXPECT_EQ(successor(), "second");
  EXPECT_EQ(watch_.leader().value().name, "first");
}

TEST_F(SourceWatchTest, TheClockOfTheHostDecidesBetweenTwo) {
  see_some("wrong", kStart + 2h);
  see_some("right", kStart);
  EXPECT_EQ(successor(), "");
  moment_.host = kStart + 50s;
  EXPECT_EQ(successor(), "right");
  moment_.host = kStart + 1h;
  EXPECT_EQ(successor(), "");
  moment_.host = kStart + 50s;
  EXPECT_EQ(count_of(watch_.follow({.name = "right", .session = 1}, moment_)), kEnough);
  EXPECT_FALSE(watch_.leader()) << "the host's clock is the clock";
  EXPECT_EQ(see_some("wrong", kStart + 2h), Verdict::Apart);
  EXPECT_EQ(see_some("right", kStart + 8s), Verdict::InTime);
  EXPECT_EQ(successor(), "");
}

TEST_F(SourceWatchTest, AtTheEndWhatContinuesThePassIsTakenAndTheHostHasTheLastWord) {
  for (const bool hosted : {false, true}) {
    watch_ = SourceWatch{kByClock, kByClock};
    moment_.host = hosted ? std::optional{kStart} : std::nullopt;
    see_some("first", kStart);
    see_some("ahead", kStart + 61s);
    see_some("farther", kStart + 2h);
    EXPECT_FALSE(watch_.successor_at_end(kEnough));
    see_some("farther", kStart + 2h + 8s, 1);
    EXPECT_EQ(watch_.successor_at_end(kEnough).has_value(), !hosted);
  }
}

TEST_F(SourceWatchTest, OneAheadIsCaughtUpWithUnlessTheHostIsAgainstIt) {
  for (const bool hosted : {false, true}) {
    watch_ = SourceWatch{kByClock, kByClock};
    moment_.host = hosted ? std::optional{kStart} : std::nullopt;
    see_some("first", kStart);
    ASSERT_EQ(see_some("ahead", kStart + 100s), Verdict::Apart);
    see_some("first", kStart + 8s, 30);
    EXPECT_FALSE(watch_.caught_up_with()) << "it is still ahead";
    see_some("first", kStart + 38s, 15);
    ASSERT_EQ(watch_.caught_up_with().has_value(), !hosted);
    if (const auto source = watch_.caught_up_with()) {
      EXPECT_EQ(count_of(watch_.take_held(*source)), kEnough);
      EXPECT_FALSE(watch_.caught_up_with());
    }
  }
}

TEST_F(SourceWatchTest, SourcesThatJumpTogetherGoOnTogether) {
  see_some("one", kStart);
  see_some("two", kStart);
  for (std::size_t i = 0; i < 2 * kEnough; ++i) {
    see("one", kStart + 30min + i * 1s);
    see("two", kStart + 30min + i * 1s);
  }
  EXPECT_NE(see("one", kStart + 31min), Verdict::Apart);
  EXPECT_NE(see("two", kStart + 31min), Verdict::Apart);
}

TEST_F(SourceWatchTest, ForgetsTheSourceNotHeardForLongest) {
  see_some("right", kStart);
  see_some("wrong", kStart + 2h);
  for (std::uint64_t session = 0; session < 2 * SourceWatch::kMostSources; ++session) {
    moment_.now += 1ms;
    see("right", kStart + 8s + session * 1ms);
    EXPECT_EQ(see("many", kStart + 3h, session), Verdict::Apart);
  }
  EXPECT_LT(watch_.apart().size(), SourceWatch::kMostSources);
  EXPECT_EQ(see("right", kStart + 10s), Verdict::InTime);
}

TEST_F(SourceWatchTest, HoldsNoMoreThanItMay) {
  see_some("right", kStart);
  see_some("wrong", kStart + 2h, SourceWatch::kMostHeld + kEnough);
  EXPECT_EQ(count_of(watch_.follow({.name = "wrong", .session = 1}, moment_)), kEnough);
}

/// Uses the limits of a live pass, with the clock of the host.
class LiveSourceWatchTest : public SourceWatchTest {
 protected:
  LiveSourceWatchTest() : SourceWatchTest{kByClock} {}

  TaiTime now() const { return kStart + moment_.now.time_since_epoch(); }
  void pass_by(std::chrono::nanoseconds time) {
    moment_.now += time;
    moment_.host = now();
  }

  /// Sends a sample of the honest source and of each other a second, the others `off`.
  Verdict see_all(std::chrono::nanoseconds off, int seconds,
                  const std::vector<std::string>& others = {"other"}) {
    Verdict of_others = Verdict::InTime;
    for (int i = 0; i < seconds; ++i) {
      pass_by(1s);
      for (const std::string& other : others) {
        of_others = see(other, now() + off);
      }
      EXPECT_NE(see("right", now()), Verdict::Apart);
      follow_if_due();
    }
    return of_others;
  }

  void follow_if_due() {
    if (const auto next = watch_.successor(moment_)) {
      watch_.follow(*next, moment_);
    }
  }
};

TEST_F(LiveSourceWatchTest, HoweverManyAreApartTheHostIsTheClock) {
  for (const auto off : {2h + 0s, -2h + 0s, 61s, -601s}) {
    watch_ = SourceWatch{kByClock, kByClock};
    see_all(0s, 1, {});
    EXPECT_EQ(see_all(off, 20, {"one", "two", "three"}), Verdict::Apart);
    EXPECT_FALSE(watch_.leader());
    EXPECT_EQ(watch_.take_news().size(), off > 0s ? 3U : 0U) << "one behind may catch up";
    see_all(off, 60, {"one", "two", "three"});
    EXPECT_EQ(watch_.apart().size(), 3U);
    EXPECT_EQ(see_all(2s, 1, {"one"}), Verdict::Healed);
  }
}

TEST_F(LiveSourceWatchTest, ThoseThatAreFirstLoseTheLeadToWhoIsInTime) {
  for (int i = 0; i < 20; ++i, pass_by(1s)) {
    moment_.host = now();
    EXPECT_EQ(see("one", now() + 2h), Verdict::InTime);
    see("two", now() + 2h);
    EXPECT_EQ(successor(), "");
  }
  EXPECT_EQ(watch_.leader().value().name, "one");
  for (std::size_t i = 0; i < kEnough; ++i, pass_by(1s)) {
    EXPECT_EQ(see("right", now()), Verdict::Apart);
  }
  ASSERT_EQ(successor(), "right");
  EXPECT_EQ(count_of(watch_.follow({.name = "right", .session = 1}, moment_)), kEnough);
  EXPECT_EQ(see_all(2h, 20, {"one", "two"}), Verdict::Apart);
}

TEST_F(LiveSourceWatchTest, WhereNoneIsInTimeTheFirstIsTheClock) {
  for (int i = 0; i < 20; ++i, pass_by(1s)) {
    moment_.host = now();
    EXPECT_EQ(see("first", now() + 2h), Verdict::InTime);
    EXPECT_EQ(see("near", now() + 2h + 50s), Verdict::InTime);
    see("far", now() - 2h);
    EXPECT_EQ(successor(), "");
  }
  EXPECT_EQ(watch_.apart().size(), 0U);
  EXPECT_EQ(see("far", now() - 2h), Verdict::Apart);
}

TEST_F(LiveSourceWatchTest, AtFourTimesRealTimeASecondStationIsInTime) {
  for (int i = 0; i < 60; ++i, pass_by(1s)) {
    moment_.host = now();
    EXPECT_EQ(see("one", kStart - 24h + i * 4s), Verdict::InTime);
    EXPECT_EQ(see("two", kStart - 24h + i * 4s - 6s), Verdict::InTime);
  }
  EXPECT_TRUE(watch_.take_news().empty());
}

TEST_F(LiveSourceWatchTest, WhatASourceSendsAgainIsLateAndNeverApart) {
  see_all(0s, 20);
  for (std::uint64_t session = 1; session < 3; ++session) {
    for (std::size_t i = 0; i < 500; ++i) {
      EXPECT_EQ(see("other", now() - 500s + i * 1s, session), Verdict::InTime);
    }
  }
  EXPECT_TRUE(watch_.take_news().empty());
  EXPECT_EQ(watch_.held(), 0U);
}

TEST_F(LiveSourceWatchTest, OneThatStaysMinutesBehindIsApart) {
  see_all(0s, 20);
  EXPECT_EQ(see_all(-3min, 50), Verdict::InTime);
  EXPECT_EQ(see_all(-3min, 20), Verdict::Apart);
  EXPECT_EQ(watch_.apart().size(), 0U);
  see_all(-3min, 60);
  EXPECT_EQ(watch_.apart().size(), 1U);
}

TEST_F(LiveSourceWatchTest, ASourceOutOfTimeLeadsOnceTheOthersAreSilent) {
  see_all(0s, 1, {});
  see_all(5min, 20);
  for (int i = 0; i < 59; ++i) {
    pass_by(1s);
    EXPECT_EQ(see("other", now() + 5min), Verdict::Apart);
    EXPECT_EQ(successor(), "");
  }
  pass_by(1s);
  see("other", now() + 5min);
  ASSERT_EQ(successor(), "other");
  watch_.follow({.name = "other", .session = 1}, moment_);
  EXPECT_EQ(watch_.leader().value().name, "other");
  for (std::size_t i = 0; i < kEnough; ++i) {
    EXPECT_EQ(successor(), "");
    pass_by(1s);
    see("other", now() + 5min);
    see("right", now(), 2);
  }
  EXPECT_EQ(successor(), "right") << "which is in time by the host";
}

TEST_F(LiveSourceWatchTest, ACodedFrameEachTwelveSecondsIsNoSilence) {
  for (int revolution = 0; revolution < 20; ++revolution) {
    moment_.host = now();
    EXPECT_EQ(see("right", now()), Verdict::InTime);
    for (int i = 0; i < 12; ++i, pass_by(1s)) {
      EXPECT_EQ(see("other", now() + 30min), Verdict::Apart);
      EXPECT_EQ(successor(), "");
    }
  }
}

TEST_F(LiveSourceWatchTest, ARestartKnowsWhoLed) {
  watch_.restore(kStart - 24h);
  watch_.restore_in_time({.source = "first", .session = 1, .seq = 0}, moment_);
  watch_.restore_in_time({.source = "second", .session = 1, .seq = 0}, moment_);
  watch_.restore_leader({.source = "second", .session = 1, .seq = 0}, moment_);
  moment_.host = now();
  EXPECT_EQ(see("second", kStart - 23h), Verdict::InTime);
  EXPECT_EQ(watch_.leader().value().name, "second");
}

}  // namespace spindrift::source_watch_test
