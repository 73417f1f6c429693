#include "pipelines/spin/sequential/gating_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <random>

#include "tests/unit/spin/noted.h"

namespace spindrift::gating_monitor_test {

using testing::note;

using enum PulseChannel;

/// A revolution of six edges, those of some channels gated.
EdgeStatistics tally_of(std::initializer_list<PulseChannel> gated) {
  EdgeStatistics tally;
  tally.accepted.set();
  for (const PulseChannel channel : gated) {
    tally.gated.set(index_of(channel));
    tally.accepted.reset(index_of(channel));
  }
  return tally;
}

const EdgeStatistics kGood = tally_of({});
const EdgeStatistics kAllGated = tally_of({Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut});

GatingMonitor after(int revolutions, const EdgeStatistics& tally) {
  return testing::noted<GatingMonitor>(revolutions, tally);
}

TEST(GatingMonitor, OfNothingSaysNothing) {
  const GatingMonitor monitor;
  EXPECT_FALSE(monitor.most_gated());
  EXPECT_FALSE(monitor.many_gated());
  EXPECT_FALSE(monitor.channel_mostly_gated());
  EXPECT_EQ(monitor.revolutions(), 0);
  EXPECT_EQ(monitor.gated(), 0);
}

TEST(GatingMonitor, CountsRevolutionsAndGatedEdges) {
  GatingMonitor monitor = after(7, tally_of({Sun1, SouthOut}));
  note(monitor, 3, kGood);
  note(monitor, 2, EdgeStatistics{});
  EXPECT_EQ(monitor.revolutions(), 12);
  EXPECT_EQ(monitor.gated(), 14);
}

/// Weights fall by an e-th in sixty edges: by half in 60 ln 2 = 42.
TEST(GatingMonitor, HalfOfTheRecentEdgesAreGatedOnceAllOfFortyTwoAre) {
  EXPECT_FALSE(after(6, kAllGated).most_gated());
  EXPECT_TRUE(after(8, kAllGated).most_gated());
  GatingMonitor late = after(1000, kGood);
  note(late, 6, kAllGated);
  EXPECT_FALSE(late.most_gated());
  note(late, 2, kAllGated);
  EXPECT_TRUE(late.most_gated());
  note(late, 2, kGood);
  EXPECT_FALSE(late.most_gated());
}

TEST(GatingMonitor, MostIsMoreThanHalf) {
  EXPECT_FALSE(after(1000, tally_of({Sun1, NorthIn, SouthIn})).most_gated());
  EXPECT_TRUE(after(1000, tally_of({Sun1, NorthIn, SouthIn, SouthOut})).most_gated());
}

TEST(GatingMonitor, WhatStartsWrongSaysSoAtOnce) {
  for (const int revolutions : {1, 2, 5, 10, 1000}) {
    EXPECT_FALSE(after(revolutions, tally_of({Sun1})).many_gated()) << revolutions;
    EXPECT_TRUE(after(revolutions, tally_of({Sun1, Sun2, NorthIn})).many_gated()) << revolutions;
  }
}

/// Of the first sixty edges the plain mean, whatever their order.
TEST(GatingMonitor, AThirdOfTheFirstEdgesAreMany) {
  GatingMonitor more = after(4, kAllGated);
  note(more, 6, kGood);  // 24 of 60.
  EXPECT_TRUE(more.many_gated());
  GatingMonitor fewer = after(3, kAllGated);
  note(fewer, 7, kGood);  // 18 of 60.
  EXPECT_FALSE(fewer.many_gated());
}

TEST(GatingMonitor, ATenthOfSpuriousEdgesIsNeverMany) {
  std::mt19937_64 rng{1};
  std::bernoulli_distribution is_gated{0.1};
  GatingMonitor monitor = after(10, kGood);
  for (int i = 0; i < 5000; ++i) {
    EdgeStatistics tally;
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      (is_gated(rng) ? tally.gated : tally.accepted).set(channel);
    }
    monitor.note(tally);
    EXPECT_FALSE(monitor.many_gated() || monitor.most_gated() || monitor.channel_mostly_gated());
  }
}

TEST(GatingMonitor, NamesTheChannelThatIsNotWhereItIsPredicted) {
  for (const PulseChannel wrong : {Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut}) {
    EXPECT_EQ(after(1, tally_of({wrong})).channel_mostly_gated(), wrong);
    GatingMonitor monitor = after(100, kGood);
    // A tenth of the weight is of the last revolution: half of it of seven.
    note(monitor, 6, tally_of({wrong}));
    EXPECT_EQ(monitor.channel_mostly_gated(), std::nullopt);
    note(monitor, 1, tally_of({wrong}));
    EXPECT_EQ(monitor.channel_mostly_gated(), wrong);
    EXPECT_FALSE(monitor.most_gated());
    note(monitor, 7, kGood);
    EXPECT_EQ(monitor.channel_mostly_gated(), std::nullopt);
  }
}

TEST(GatingMonitor, OfTwoChannelsNamesTheWorse) {
  GatingMonitor monitor = after(10, tally_of({NorthIn, SouthOut}));
  note(monitor, 1, tally_of({SouthOut}));
  EXPECT_EQ(monitor.channel_mostly_gated(), SouthOut);
}

}  // namespace spindrift::gating_monitor_test
