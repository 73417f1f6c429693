#include "pipelines/spin/association/association.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/edge_train.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::association_test {

using enum PulseChannel;

TEST(Association, GivesEveryEdgeItsRevolutionAtRatesUnknownBeforehand) {
  for (const double rpm : {5.0, 17.3, 60.0, 99.2177, 200.0}) {
    SCOPED_TRACE(rpm);
    const auto edges = made({.period_s = 60.0 / rpm, .turns = 60, .noise_s = 1e-4});
    const Association all = associate(edges);
    expect_every_edge_on_its_turn(all, edges);
    EXPECT_EQ(all.closed.size(), 60U);
    EXPECT_TRUE(all.left_over.empty());
    EXPECT_NEAR(all.closed.back().period.period_s, 60.0 / rpm,
                5.0 * all.closed.back().period.sigma_s);
  }
}

TEST(Association, RevolutionsCloseInOrderAndTheIntervalThatEndsAtASun1IsItsPeriodCandidate) {
  const Association all = associate(made({}));
  EXPECT_TRUE(std::ranges::is_sorted(all.closed, {}, &Revolution::number));
  EXPECT_EQ(all.closed.front().number, 0);
  EXPECT_FALSE(all.closed.front().period_candidate);
  for (std::size_t i = 1; i < all.closed.size(); ++i) {
    ASSERT_TRUE(all.closed[i].period_candidate);
    ASSERT_NEAR(all.closed[i].period_candidate->period_s, kPeriod_s, 1e-9);
    ASSERT_FALSE(all.closed[i].period_candidate->rejected_by);
  }
}

TEST(Association, LostEdgesLeaveTheOthersWhereTheyBelong) {
  std::mt19937_64 rng{51};
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    std::bernoulli_distribution lost{0.2};
    const auto edges = without(made({.turns = 150, .noise_s = 1e-4}, rng),
                               [&](const MadeEdge& e) { return e.turn > 0 && lost(rng); });
    // The count begins at the first sun1 with a successor, a channel after three consistent edges.
    const Association all = associate(edges);
    const std::size_t before_first = all.left_over.size();
    EXPECT_LT(before_first, 40U);
    std::array<int, kPulseChannels> seen{};
    expect_every_edge_on_its_turn(
        all, without(edges, [&](const MadeEdge& edge) {
          const bool early = ++seen.at(index_of(edge.pulse.channel)) < 5 ||
                             edge.pulse.t < all.closed.front().edges[0];
          return early && std::ranges::any_of(all.left_over, [&](const PulseUse& use) {
                   return use.pulse == edge.pulse;
                 });
        }));
  }
}

TEST(Association, OfDoubledEdgesTheNearerToItsPlaceStays) {
  for (const double noise_s : {0.0, 1e-4}) {
    for (const double echo_turns : {-0.03, -0.008, 0.008, 0.03}) {
      SCOPED_TRACE(::testing::Message() << echo_turns << " turns, noise " << noise_s);
      const auto edges = made({.noise_s = noise_s});
      std::vector<Pulse> pulses = pulses_of(edges);
      for (const MadeEdge& edge : edges) {
        if (edge.turn % 7 == 3) {
          pulses.push_back(
              {.t = shifted(edge.pulse.t, echo_turns * kPeriod_s), .channel = edge.pulse.channel});
        }
      }
      const Association all = associate(pulses);
      expect_every_edge_on_its_turn(all, edges);
      EXPECT_EQ(all.left_over.size(), pulses.size() - edges.size());
      for (const PulseUse& use : all.left_over) {
        EXPECT_EQ(use.rejected_by, Rejection::Unassociated);
      }
    }
  }
}

TEST(Association, SpuriousEdgesAreLeftOver) {
  std::mt19937_64 rng{52};
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    const auto edges = made({.noise_s = 1e-4}, rng);
    std::vector<Pulse> pulses = pulses_of(edges);
    std::uniform_real_distribution<double> t_s{0.0, 100.0 * kPeriod_s};
    std::uniform_int_distribution<int> channel{0, static_cast<int>(kPulseChannels) - 1};
    for (int i = 0; i < 40; ++i) {
      pulses.push_back(
          {.t = shifted(kStart, t_s(rng)), .channel = static_cast<PulseChannel>(channel(rng))});
    }
    const Association all = associate(pulses);
    const auto found = places(all);
    // The count begins at the first sun1 with an undisturbed successor.
    const auto first_sun1 = all.closed.front().edge(Sun1);
    ASSERT_LE(first_sun1, shifted(kStart, 5.0 * kPeriod_s));
    // A spurious edge within the noise (0.1 ms) of a genuine one cannot be distinguished from it.
    const auto stands_in_for = [](const MadeEdge& edge) {
      return [&edge](const auto& place) {
        return place.first.channel == edge.pulse.channel &&
               std::abs(seconds_between(place.first.t, edge.pulse.t)) < 5e-4;
      };
    };
    for (const MadeEdge& edge : edges) {
      if (edge.pulse.t >= first_sun1) {
        ASSERT_TRUE(found.contains(edge.pulse) || std::ranges::any_of(found, stands_in_for(edge)))
            << name_of(edge.pulse.channel) << " " << edge.turn;
      }
    }
  }
}

/// Returns edges of which those of the Earth begin after this many turns.
std::vector<MadeEdge> earth_after(int turns) {
  return without(made({}), [turns](const MadeEdge& edge) {
    return edge.turn < turns && !sees_the_sun(edge.pulse.channel);
  });
}

TEST(Association, ASpuriousEdgeDoesNotClaimAChannelThatBeginsLate) {
  const auto edges = earth_after(50);
  std::vector<Pulse> pulses = pulses_of(edges);
  pulses.push_back({.t = shifted(kStart, 30.9 * kPeriod_s), .channel = NorthIn});
  const Association all = associate(pulses);
  int chords = 0;
  for (const Revolution& revolution : all.closed) {
    chords += revolution.edge(NorthIn) && revolution.edge(NorthOut) ? 1 : 0;
  }
  EXPECT_GE(chords, 40);
}

TEST(Association, EdgesBeforeTheFirstSun1AreLeftOver) {
  const auto all_edges = made({});
  const auto edges = without(
      all_edges, [](const MadeEdge& edge) { return edge.turn == 0 && edge.pulse.channel == Sun1; });
  const Association all = associate(edges);
  EXPECT_EQ(all.left_over.size(), 5U);
  for (const PulseUse& use : all.left_over) {
    EXPECT_EQ(use.rejected_by, Rejection::Unassociated);
    EXPECT_FALSE(use.revolution);
  }
  expect_every_edge_on_its_turn(
      all, without(edges, [](const MadeEdge& edge) { return edge.turn == 0; }));
}

// Closer to the pass, a stray edge could be a first edge followed by lost ones.
TEST(Association, AStrayEdgeBeforeThePassIsNotItsFirst) {
  const auto edges = made({.noise_s = 1e-4});
  const Pulse& first = edges.front().pulse;
  for (const PulseChannel channel : {Sun1, Sun2, NorthIn}) {
    for (int strays = 1; strays <= 2; ++strays) {
      for (double before_turns = 10.5; before_turns < 70.0; before_turns += 0.97) {
        SCOPED_TRACE(::testing::Message() << strays << " of " << name_of(channel) << ", "
                                          << before_turns << " turns before");
        std::vector<Pulse> pulses = pulses_of(edges);
        for (int i = 1; i <= strays; ++i) {
          pulses.insert(pulses.begin(),
                        {.t = shifted(first.t, -i * before_turns * kPeriod_s), .channel = channel});
        }
        const Association all = associate(pulses);
        EXPECT_GE(all.left_over.size(), static_cast<std::size_t>(strays));
        ASSERT_FALSE(all.closed.empty());
        EXPECT_EQ(all.closed.front().number, 0);
        EXPECT_EQ(all.closed.front().edge(Sun1), first.t);
        EXPECT_EQ(all.closed.size(), 100U);
      }
    }
  }
}

TEST(Association, AChannelThatBeginsLateIsBelievedWithItsThirdEdge) {
  const Association all = associate(earth_after(50));
  EXPECT_EQ(all.left_over.size(), 8U);
  expect_every_edge_on_its_turn(all, earth_after(52));
}

/// Strays of a silent channel, including doubled ones, do not make a channel.
TEST(Association, StraysOfASilentChannelFindNoPlace) {
  for (const PulseChannel silent : {Sun2, NorthIn, SouthOut}) {
    const auto edges = without(made({.turns = 2000, .noise_s = 1e-4}),
                               [&](const MadeEdge& edge) { return edge.pulse.channel == silent; });
    std::mt19937_64 rng{56};
    std::uniform_real_distribution<double> uniform;
    std::vector<Pulse> pulses = pulses_of(edges);
    for (int turn = 0; turn < 2000; ++turn) {
      for (int echo = 0; echo < 2 && uniform(rng) < 0.05; ++echo) {
        const double phase = uniform(rng);
        pulses.push_back({.t = shifted(kStart, (turn + phase) * kPeriod_s), .channel = silent});
        pulses.push_back(
            {.t = shifted(kStart, (turn + phase) * kPeriod_s + 1e-4), .channel = silent});
      }
    }
    for (const Revolution& revolution : associate(pulses).closed) {
      EXPECT_FALSE(revolution.good_edge(silent)) << revolution.number;
    }
  }
}

/// After a long silence, one edge near the old phase counts as a stray.
TEST(Association, AChannelThatFellSilentHasToShowItselfAnew) {
  const auto edges = without(made({.turns = 200, .noise_s = 1e-4}), [](const MadeEdge& edge) {
    return edge.pulse.channel == Sun2 && edge.turn > 50 && edge.turn != 120 && edge.turn < 150;
  });
  const Association all = associate(edges);
  for (const Revolution& revolution : all.closed) {
    const bool seen = revolution.number <= 50 || revolution.number >= 152;
    EXPECT_EQ(revolution.good_edge(Sun2).has_value(), seen) << revolution.number;
  }
}

TEST(Association, AShortPassIsAssociatedWhenItEnds) {
  const auto edges = made({.turns = 3});
  const Association all = associate(edges);
  EXPECT_EQ(all.closed.size(), 3U);
  expect_every_edge_on_its_turn(all, edges);
}

TEST(Association, WithoutAPeriodEveryEdgeIsLeftOver) {
  const auto edges = made({.turns = 2});  // Two turns give a single interval only.
  const Association all = associate(edges);
  EXPECT_TRUE(all.closed.empty());
  EXPECT_EQ(all.left_over.size(), edges.size());
}

TEST(Association, EdgesWithoutAPeriodDoNotAccumulate) {
  Associator associator{usual_config()};
  std::mt19937_64 rng{54};
  std::exponential_distribution<double> gap_s{10.0};
  TaiTime t = kStart;
  std::size_t held = 0;
  for (int i = 0; i < 20000; ++i) {
    t = shifted(t, gap_s(rng));
    held += 1;
    const Association out = associator.push({.t = t, .channel = i % 2 == 0 ? NorthIn : SouthIn});
    held -= out.left_over.size();
    ASSERT_LE(held, 2000U);
  }
  held -= associator.finish().left_over.size();
  EXPECT_EQ(held, 0U);
}

TEST(Association, EveryEdgeComesOutExactlyOnce) {
  std::mt19937_64 rng{55};
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    std::bernoulli_distribution lost{0.3};
    std::vector<Pulse> pulses = pulses_of(
        without(made({.noise_s = 1e-3}, rng), [&](const MadeEdge&) { return lost(rng); }));
    std::uniform_real_distribution<double> t_s{-5.0, 100.0};
    std::uniform_int_distribution<int> channel{0, static_cast<int>(kPulseChannels) - 1};
    for (int i = 0; i < 100; ++i) {
      pulses.push_back(
          {.t = shifted(kStart, t_s(rng)), .channel = static_cast<PulseChannel>(channel(rng))});
    }
    std::ranges::sort(pulses);

    const Association all = associate(pulses);
    std::vector<Pulse> out;
    for (const auto& [pulse, number] : places(all)) {
      out.push_back(pulse);
    }
    for (const PulseUse& use : all.left_over) {
      out.push_back(use.pulse);
    }
    std::ranges::sort(out);
    ASSERT_EQ(out, pulses);
  }
}

}  // namespace spindrift::testing::association_test
