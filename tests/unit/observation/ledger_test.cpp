#include "pipelines/observation/ledger.h"

#include <random>
#include <set>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::ledger_test {

using enum SampleSource;

constexpr RecordRules kRules{
    .recent = 60.0, .fewest_freedoms = 15.0, .most_freedoms = 300.0, .noise_from_share = 0.2};
const std::vector<SampleSource> kEdges{Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut};

/// Returns a turn of six edges of which `left_out` are left out.
std::vector<Observation> turn(const std::set<SampleSource>& left_out) {
  std::vector<Observation> edges;
  for (const SampleSource source : kEdges) {
    Observation edge{.source = source, .residual = {.freedom = 1}, .nis = 1.0, .limit = 16.81};
    edge.residual.value[0] = 1e-4;
    edge.residual.sigma[0] = 1e-4;
    if (left_out.contains(source)) {
      edge.rejected_by = Rejection::Innovation;
    }
    edges.push_back(edge);
  }
  return edges;
}

const std::set<SampleSource> kAll{kEdges.begin(), kEdges.end()};

Ledger& add(Ledger& ledger, int turns, const std::set<SampleSource>& left_out) {
  const std::vector<Observation> edges = turn(left_out);
  for (int i = 0; i < turns; ++i) {
    ledger.add(edges);
  }
  return ledger;
}

Ledger after(int turns, const std::set<SampleSource>& left_out) {
  Ledger ledger{kRules};
  return add(ledger, turns, left_out);
}

TEST(Ledger, OfNothingSaysNothing) {
  const Ledger ledger{kRules};
  EXPECT_EQ(ledger.all().share_left_out(), 0.0);
  EXPECT_EQ(ledger.all().excess_noise(), 1.0);
  EXPECT_FALSE(ledger.mostly_left_out());
  EXPECT_EQ(ledger.turns(), 0);
  EXPECT_EQ(ledger.oscillation(Sun1), 1.0);
}

TEST(Ledger, CountsTurnsAndWhatIsLeftOut) {
  Ledger ledger = after(7, {Sun1, SouthOut});
  add(ledger, 3, {});
  ledger.add({});
  EXPECT_EQ(ledger.turns(), 11);
  EXPECT_EQ(ledger.all().left_out(), 14);
  EXPECT_EQ(ledger.of(Sun1).left_out(), 7);
  EXPECT_EQ(ledger.of(Sun2).left_out(), 0);
}

/// Weights decay by 1/e in sixty edges, so by half in 60 ln 2 = 42.
TEST(Ledger, HalfOfTheRecentAreLeftOutOnceAllOfFortyTwoAre) {
  EXPECT_LT(after(6, kAll).all().recent_share_left_out(), 0.5);
  EXPECT_GT(after(8, kAll).all().recent_share_left_out(), 0.5);
  Ledger late = after(1000, {});
  EXPECT_LT(add(late, 6, kAll).all().recent_share_left_out(), 0.5);
  EXPECT_GT(add(late, 2, kAll).all().recent_share_left_out(), 0.5);
  EXPECT_LT(add(late, 2, {}).all().recent_share_left_out(), 0.5);
}

TEST(Ledger, WhatStartsWrongSaysSoAtOnce) {
  for (const int turns : {1, 2, 5, 10, 1000}) {
    EXPECT_NEAR(after(turns, {Sun1}).all().share_left_out(), 1.0 / 6.0, 0.02) << turns;
    EXPECT_NEAR(after(turns, {Sun1, Sun2, NorthIn}).all().share_left_out(), 0.5, 0.03) << turns;
  }
}

/// The first sixty edges have equal weights, whatever their order.
TEST(Ledger, OfTheFirstSixtyEdgesTheShareIsPlain) {
  Ledger ledger = after(4, kAll);
  EXPECT_NEAR(add(ledger, 6, {}).all().share_left_out(), 24.0 / 60.0, 1e-12);
}

TEST(Ledger, ATenthOfSpuriousEdgesNamesNoSource) {
  std::mt19937_64 rng{1};
  std::bernoulli_distribution is_spurious{0.1};
  Ledger ledger = after(10, {});
  for (int i = 0; i < 5000; ++i) {
    std::set<SampleSource> spurious;
    for (const SampleSource source : kEdges) {
      if (is_spurious(rng)) {
        spurious.insert(source);
      }
    }
    ledger.add(turn(spurious));
    ASSERT_FALSE(ledger.mostly_left_out());
    ASSERT_LT(ledger.all().share_left_out(), 1.0 / 3.0);
  }
}

TEST(Ledger, NamesTheSourceThatIsNotWhereItIsPredicted) {
  for (const SampleSource wrong : kEdges) {
    EXPECT_EQ(after(1, {wrong}).mostly_left_out(), wrong);
    Ledger ledger = after(100, {});
    // The last turn has a tenth of the weight; half of it is that of one edge in seven.
    EXPECT_FALSE(add(ledger, 6, {wrong}).mostly_left_out());
    EXPECT_EQ(add(ledger, 1, {wrong}).mostly_left_out(), wrong);
    EXPECT_FALSE(add(ledger, 7, {}).mostly_left_out());
  }
}

TEST(Ledger, OfTwoSourcesNamesTheWorse) {
  Ledger ledger = after(10, {NorthIn, SouthOut});
  EXPECT_EQ(add(ledger, 1, {SouthOut}).mostly_left_out(), SouthOut);
}

TEST(Ledger, BegunAnewHasNoSharesAndCounts) {
  Ledger ledger = after(100, kAll);
  ledger.restart();
  EXPECT_EQ(ledger.turns(), 0);
  EXPECT_EQ(ledger.all().left_out(), 0);
  EXPECT_EQ(ledger.all().share_left_out(), 0.0);
  EXPECT_FALSE(ledger.mostly_left_out());
}

TEST(Ledger, SaysOfEverySourceThatSpokeWhatIsUsedAndHowItScatters) {
  Ledger ledger{kShownRules};
  add(ledger, 100, {NorthIn});
  const std::vector<SourceSummary> sources = ledger.sources();
  ASSERT_EQ(sources.size(), kEdges.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    EXPECT_EQ(sources[i].source, kEdges[i]);
    const bool is_left_out = kEdges[i] == NorthIn;
    EXPECT_DOUBLE_EQ(sources[i].used, is_left_out ? 0.0 : 1.0);
    EXPECT_EQ(sources[i].noise, is_left_out ? std::nullopt : std::optional{1.0});
  }
}

}  // namespace spindrift::ledger_test
