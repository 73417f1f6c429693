#include "services/processor/source_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "services/processor/steady_time.h"

namespace spindrift::source_watch_test {

using namespace std::chrono_literals;
using Verdict = SourceWatch::Verdict;

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr std::size_t kEnough = PassWatch::kEnoughToAccept;

class SourceWatchTest : public ::testing::Test {
 protected:
  explicit SourceWatchTest(const Pace& pace = kReplayPace) : watch_{pace} {}

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
  EXPECT_EQ(see("other", kStart + 75s), Verdict::Apart);
  EXPECT_EQ(see("other", kStart + 9s), Verdict::Healed);
  EXPECT_EQ(count_of(watch_.take_held({.source = "other", .session = 1, .seq = 0})), 0U);
  EXPECT_EQ(see("other", kStart - 54s), Verdict::Apart) << "61 s behind";
  EXPECT_EQ(see_some("other", kStart + 10s), Verdict::Healed);
  EXPECT_EQ(count_of(watch_.take_held({.source = "other", .session = 1, .seq = 0})), 1U);
  const auto news = watch_.take_news();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].source.name, "other");
  EXPECT_EQ(news[0].t, kStart + 75s);
  EXPECT_EQ(news[0].pass, kStart + 7s);
  EXPECT_TRUE(news[1].healed);
  EXPECT_EQ(successor(), "");
}

TEST_F(SourceWatchTest, InAReplayOneThatGoesOnFasterThanTheOthersIsInTime) {
  see_some("slow", kStart);
  EXPECT_EQ(see_some("fast", kStart, 600), Verdict::InTime);
  EXPECT_EQ(see("slow", kStart + 8s), Verdict::Apart);
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
  moment_.now += kReplayPace.silence;
  EXPECT_EQ(successor(), "");
  see("second", kStart + 30min + 7s);
  EXPECT_EQ(successor(), "second");
  EXPECT_EQ(count_of(watch_.follow({.name = "second", .session = 1})), kEnough);
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

TEST_F(SourceWatchTest, OneBehindMayCatchUpBeforeItFollows) {
  see_some("first", kStart + 2h);
  moment_.now += 1min;
  see_some("second", kStart);
  EXPECT_EQ(successor(), "");
  ASSERT_EQ(watch_.next_decision(), moment_.now + kReplayPace.silence);
  EXPECT_FALSE(watch_.successor_at_end(kEnough));
  EXPECT_TRUE(watch_.successor_at_end(kEnough - 1));
  moment_.now = *watch_.next_decision();
  EXPECT_EQ(successor(), "second");
  EXPECT_EQ(watch_.carrier().value().name, "first");
}

TEST_F(SourceWatchTest, TheClockOfTheHostDecidesBetweenTwo) {
  see_some("wrong", kStart + 2h);
  see_some("right", kStart);
  EXPECT_EQ(successor(), "");
  moment_.host = kStart + 5min;
  EXPECT_EQ(successor(), "right");
  moment_.host = kStart + 1h;
  EXPECT_EQ(successor(), "");
  moment_.host = kStart + 2h;
  EXPECT_EQ(successor(), "");
}

TEST_F(SourceWatchTest, MoreSourcesThanOneOutvoteItNotMoreSessions) {
  see_some("wrong", kStart);
  see_some("right", kStart + 2h);
  for (std::uint64_t session = 2; session < 5; ++session) {
    for (std::size_t i = 0; i < kEnough; ++i) {
      see("right", kStart + 2h + i * 1s, session);
    }
  }
  EXPECT_EQ(successor(), "");
  see_some("right as well", kStart + 2h);
  EXPECT_NE(successor(), "");
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
  EXPECT_EQ(count_of(watch_.follow({.name = "wrong", .session = 1})), kEnough);
}

/// Uses the pace of a live pass, where time advances with the wall clock.
class LiveSourceWatchTest : public SourceWatchTest {
 protected:
  LiveSourceWatchTest() : SourceWatchTest{kLivePace} {}

  TaiTime now() const { return kStart + moment_.now.time_since_epoch(); }
  void pass_by(std::chrono::nanoseconds time) { moment_.now += time; }

  /// Sends a sample of both sources each second, the other one's `off` from the right time.
  Verdict see_both(std::chrono::nanoseconds off, int seconds, const std::string& right = "right",
                   const std::string& other = "other") {
    Verdict of_other = Verdict::InTime;
    for (int i = 0; i < seconds; ++i) {
      EXPECT_EQ(see(right, now()), Verdict::InTime);
      EXPECT_EQ(successor(), "");
      of_other = see(other, now() + off);
      EXPECT_EQ(successor(), "");
      pass_by(1s);
    }
    return of_other;
  }
};

TEST_F(LiveSourceWatchTest, OneSecondsAheadIsApartAndNamedAtOnce) {
  for (const auto ahead : {6s, 19s, 37s}) {
    watch_ = SourceWatch{kLivePace};
    see_both(0s, 10);
    EXPECT_EQ(see_both(ahead, 20), Verdict::Apart);
    const auto news = watch_.take_news();
    ASSERT_EQ(news.size(), 1U);
    EXPECT_EQ(news[0].source.name, "other");
  }
  EXPECT_EQ(see_both(2s, 20), Verdict::Healed);
}

TEST_F(LiveSourceWatchTest, OneThatCreepsAheadIsApart) {
  see_both(0s, 10);
  for (int i = 0; i < 20; ++i) {
    see_both(i * 1s, 1);
  }
  EXPECT_EQ(watch_.apart().size(), 1U);
}

TEST_F(LiveSourceWatchTest, OneThatComesTwelveSecondsLateIsNotLeftOutAndHasNoSay) {
  EXPECT_EQ(see_both(-12s, 30), Verdict::InTime);
  EXPECT_EQ(watch_.carrier().value().name, "right");
  EXPECT_TRUE(watch_.take_news().empty());
  see_both(-12s, 50);
  EXPECT_EQ(watch_.take_news().size(), 1U) << "which does not catch up, and is named";
}

TEST_F(LiveSourceWatchTest, ACodedFrameEachTwelveSecondsIsNoSilence) {
  for (int revolution = 0; revolution < 20; ++revolution) {
    EXPECT_EQ(see("right", now()), Verdict::InTime);
    for (int i = 0; i < 12; ++i, pass_by(1s)) {
      if (revolution >= 8) {
        EXPECT_EQ(see("other", now() + 30min), Verdict::Apart);
        EXPECT_EQ(successor(), "");
      }
    }
  }
}

TEST_F(LiveSourceWatchTest, APauseOfSecondsHandsThePassToNobody) {
  see_both(5min, 20);
  for (int i = 0; i < 50; ++i) {
    see("other", now() + 5min);
    EXPECT_EQ(successor(), "");
    pass_by(1s);
  }
  EXPECT_EQ(see("right", now()), Verdict::InTime);
}

TEST_F(LiveSourceWatchTest, AfterAnOutageANewSessionGoesOnAtOnce) {
  see_both(0s, 20);
  pass_by(10min);
  EXPECT_EQ(see("right", now(), 2), Verdict::InTime);
}

TEST_F(LiveSourceWatchTest, OneThatDisplacedASilentOneGivesThePassBackByTheHost) {
  see_both(5min, 20);
  for (int i = 0; i < 70; ++i) {
    see("other", now() + 5min);
    pass_by(1s);
  }
  ASSERT_EQ(successor(), "other");
  watch_.follow({.name = "other", .session = 1});
  for (std::size_t i = 0; i < kEnough; ++i) {
    see("other", now() + 5min);
    see("right", now());
    pass_by(1s);
  }
  EXPECT_EQ(successor(), "");
  moment_.host = now();
  EXPECT_EQ(successor(), "right");
}

TEST_F(LiveSourceWatchTest, OfAsManyVotesThePassGoesOn) {
  moment_.host = now();
  for (std::size_t i = 0; i < 3 * kEnough; ++i) {
    moment_.host = now();
    see("right", now());
    EXPECT_EQ(successor(), "");
    see("wrong", now() + 2h);
    EXPECT_EQ(successor(), "");
    see("wrong as well", now() + 2h);
    EXPECT_EQ(successor(), "") << "two votes, as of the source and of the host";
    pass_by(1s);
  }
  see_some("a third", now() + 2h - 8s);
  EXPECT_NE(successor(), "");
}

TEST_F(LiveSourceWatchTest, ThreeSourcesOutvoteOneThatTheHostIsFor) {
  for (std::size_t i = 0; i < 3 * kEnough; ++i) {
    moment_.host = now() + 2h;
    for (const std::string right : {"one", "two", "three"}) {
      see(right, now());
    }
    see("wrong", now() + 2h);
    EXPECT_EQ(successor(), "");
    pass_by(1s);
  }
}

}  // namespace spindrift::source_watch_test
