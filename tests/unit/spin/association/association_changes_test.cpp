/// Association of edges that change during the pass: moving chords, drifting or stepping rates,
/// silences.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/spin/association/association.h"
#include "tests/support/edge_train.h"
#include "tests/support/matchers.h"

namespace spindrift::association_changes_test {

using enum PulseChannel;

TEST(Association, AChordThatStraddlesSun1StaysInOnePiece) {
  const auto edges = made({.phases_turns = {0.0, 0.11, 0.93, 1.07, 0.95, 1.10}});
  const Association all = associate(edges);
  EXPECT_TRUE(all.left_over.empty());
  expect_every_edge_on_its_turn(all, edges);
}

TEST(Association, AChordThatHoversAboutSun1StaysInOnePiece) {
  std::mt19937_64 rng{53};
  for (const double middle_turns : {-0.07, -0.001, 0.0, 0.001, 0.07}) {
    SCOPED_TRACE(middle_turns);
    const auto edges = made({.phases_turns = {0.0, 0.11, middle_turns - 0.07, middle_turns + 0.07,
                                              middle_turns - 0.0001, middle_turns + 0.12},
                             .turns = 200,
                             .noise_s = 2e-3},
                            rng);
    const Association all = associate(edges);
    // The chord around the first sun1 lies at least partly before the count begins.
    EXPECT_LE(all.left_over.size(), 4U);
    int whole = 0;
    for (const Revolution& revolution : all.closed) {
      for (const auto& [in, out, chord_turns] :
           {std::tuple{NorthIn, NorthOut, 0.14}, std::tuple{SouthIn, SouthOut, 0.1201}}) {
        if (revolution.edge(in) && revolution.edge(out)) {
          // Five sigma of the difference of two edges.
          ASSERT_NEAR(seconds_between(*revolution.edge(in), *revolution.edge(out)),
                      chord_turns * kPeriod_s, 5.0 * std::numbers::sqrt2 * 2e-3);
          ++whole;
        }
      }
    }
    EXPECT_GE(whole, 2 * 199);
  }
}

TEST(Association, AChordThatDriftsPastSun1StaysInOnePiece) {
  for (const double drift_turns : {-0.003, 0.003}) {
    SCOPED_TRACE(drift_turns);
    std::vector<Pulse> pulses;
    constexpr int kTurns = 400;
    // The period is long enough for the Earth to move noticeably within it.
    constexpr double kSlowPeriod_s = 6.0;
    for (int turn = 0; turn < kTurns; ++turn) {
      const double in_turns = 0.5 + drift_turns * turn;
      for (const auto& [channel, phase] :
           {std::pair{Sun1, 0.0}, std::pair{Sun2, 0.11}, std::pair{NorthIn, in_turns},
            std::pair{NorthOut, in_turns + 0.13}}) {
        pulses.push_back(
            {.t = shifted(kStart, (turn + phase) * kSlowPeriod_s), .channel = channel});
      }
    }
    const Association all = associate(pulses);
    int whole = 0;
    for (const Revolution& revolution : all.closed) {
      ASSERT_EQ(revolution.edge(NorthIn).has_value(), revolution.edge(NorthOut).has_value())
          << revolution.number;
      if (revolution.edge(NorthIn)) {
        ASSERT_NEAR(seconds_between(*revolution.edge(NorthIn), *revolution.edge(NorthOut)),
                    0.13 * kSlowPeriod_s, 1e-8);
        ++whole;
      }
      if (revolution.edge(Sun1) && revolution.edge(NorthIn)) {
        // The edge stays near the turn that it is counted with.
        const double in_turns =
            seconds_between(*revolution.edge(Sun1), *revolution.edge(NorthIn)) / kSlowPeriod_s;
        ASSERT_GT(in_turns, -0.3);
        ASSERT_LT(in_turns, 1.3);
      }
    }
    // After 1.2 turns of drift at most two chords have no turn of their own.
    EXPECT_GE(whole, kTurns - 2);
  }
}

TEST(Association, AChordThatMovedDuringASilenceIsFoundAgain) {
  std::vector<MadeEdge> edges = made({.turns = 50});
  const auto sun = without(made({.turns = 350}), [](const MadeEdge& edge) {
    return edge.turn < 50 || !sees_the_sun(edge.pulse.channel);
  });
  const auto later =
      without(made({.phases_turns = {0.0, 0.11, 0.70, 0.82, 0.71, 0.85}, .turns = 450}),
              [](const MadeEdge& edge) { return edge.turn < 350; });
  edges.insert(edges.end(), sun.begin(), sun.end());
  edges.insert(edges.end(), later.begin(), later.end());
  const Association all = associate(edges);
  int chords = 0;
  for (const Revolution& revolution : all.closed) {
    const auto& in = revolution.edge(NorthIn);
    chords += in && *in > shifted(kStart, 350.0 * kPeriod_s) && revolution.edge(NorthOut) ? 1 : 0;
  }
  EXPECT_GE(chords, 80);
}

TEST(Association, AStepInTheSpinRateIsFollowed) {
  for (const double step : {-0.3, -0.05, 0.01, 0.05, 0.2, 0.5}) {
    SCOPED_TRACE(step);
    std::vector<Pulse> pulses;
    double t_s = 0.0;
    for (int turn = 0; turn < 200; ++turn) {
      const double period_s = turn < 100 ? kPeriod_s : kPeriod_s * (1.0 + step);
      pulses.push_back({.t = shifted(kStart, t_s), .channel = Sun1});
      pulses.push_back({.t = shifted(kStart, t_s + 0.11 * period_s), .channel = Sun2});
      t_s += period_s;
    }
    const Association all = associate(pulses);
    // Six of nine intervals must agree, so both edges of at least five turns are lost.
    EXPECT_LE(all.left_over.size(), 20U);
    EXPECT_NEAR(all.closed.back().period.period_s, kPeriod_s * (1.0 + step), 1e-6);
    EXPECT_TRUE(std::ranges::is_sorted(all.closed, {}, &Revolution::number));
  }
}

/// The other channels keep to the clock.
TEST(Association, AStepOfSun1AloneIsNoneInTheSpinRate) {
  for (const auto& [late, step] : {std::pair{0.0, -0.013}, std::pair{0.08, 0.0}}) {
    SCOPED_TRACE(step);
    std::vector<Pulse> pulses;
    for (const MadeEdge& edge : made({.turns = 200})) {
      pulses.push_back(edge.pulse);
      if (edge.turn >= 100 && edge.pulse.channel == Sun1) {
        pulses.back().t = shifted(edge.pulse.t, (late + step * (edge.turn - 100)) * kPeriod_s);
      }
    }
    std::ranges::sort(pulses);
    const Association all = associate(pulses);
    EXPECT_NEAR(all.closed.back().period.period_s, kPeriod_s, 1e-3);
    int chords = 0;
    for (const Revolution& revolution : all.closed) {
      chords += revolution.good_edge(NorthIn) && revolution.good_edge(SouthOut) ? 1 : 0;
    }
    EXPECT_GE(chords, 195);
  }
}

/// The edges before and after the time step lie a third of a turn apart and overlap.
TEST(Association, AStepBackInTimeIsNoStepInTheSpinRate) {
  for (const double fraction_turns : {1.0 / 4.0, 1.0 / 3.0, 2.0 / 5.0, 2.0 / 3.0}) {
    SCOPED_TRACE(fraction_turns);
    std::vector<Pulse> pulses;
    for (int turn = 0; turn < 200; ++turn) {
      const double stepped_turns = turn < 100 ? 0.0 : 6.0 + fraction_turns;
      for (const auto& [channel, phase] : {std::pair{Sun1, 0.0}, std::pair{Sun2, 0.11}}) {
        pulses.push_back(
            {.t = shifted(kStart, (turn - stepped_turns + phase) * kPeriod_s), .channel = channel});
      }
    }
    const Association all = associate(pulses);
    for (const Revolution& revolution : all.closed) {
      EXPECT_NEAR(revolution.period.period_s, kPeriod_s, 0.1 * kPeriod_s) << revolution.number;
    }
    EXPECT_LE(all.left_over.size(), 60U);
  }
}

TEST(Association, TheCountIsRightAfterMinutesOfSilence) {
  for (const double rpm : {5.0, 60.0, 200.0}) {
    SCOPED_TRACE(rpm);
    const double period_s = 60.0 / rpm;
    const int silent_turns = static_cast<int>(5.0 * 60.0 / period_s);
    const auto edges = without(
        made({.period_s = period_s, .turns = 50 + silent_turns + 50, .noise_s = 1e-4}),
        [&](const MadeEdge& edge) { return edge.turn >= 50 && edge.turn < 50 + silent_turns; });
    const Association all = associate(edges);
    EXPECT_TRUE(all.left_over.empty());
    expect_every_edge_on_its_turn(all, edges);
    const Revolution& last = all.closed.back();
    EXPECT_NEAR(last.period.period_s, period_s, 5.0 * last.period.sigma_s);
  }
}

std::vector<MadeEdge> made_drifting(double rate_rpm, double drift_rpm_h, int turns,
                                    std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const double rate = rate_rpm / 60.0;
  const double drift = drift_rpm_h / 60.0 / 3600.0;
  std::vector<MadeEdge> edges;
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const double phase = turn + kOrdinary.at(channel);
      const double t_s = 2.0 * phase / (rate + std::sqrt(rate * rate + 2.0 * drift * phase));
      edges.push_back({.pulse = {.t = shifted(kStart, t_s + 1e-4 * normal(rng)),
                                 .channel = static_cast<PulseChannel>(channel)},
                       .turn = turn});
    }
  }
  return edges;
}

TEST(Association, ADriftOfTheRateIsFollowed) {
  std::mt19937_64 rng{57};
  for (const double rate_rpm : {5.0, 12.0, 60.0, 200.0}) {
    for (const double drift_rpm_h : {0.05, 0.5, 2.0}) {
      SCOPED_TRACE(std::to_string(rate_rpm) + " rpm, " + std::to_string(drift_rpm_h) + " rpm/h");
      const auto edges = made_drifting(rate_rpm, drift_rpm_h, 200, rng);
      const Association all = associate(edges);
      expect_every_edge_on_its_turn(all, edges);
      std::ptrdiff_t rejected = 0;
      for (const Revolution& revolution : all.closed) {
        rejected += std::ranges::count_if(revolution.edge_rejections, [](const auto& rejection) {
          return rejection.has_value();
        });
      }
      EXPECT_LE(rejected, 12);  // One in a hundred edges.
    }
  }
}

TEST(Association, SaysWhenASilenceWasTooLongToCount) {
  std::mt19937_64 rng{58};
  const auto edges = made_drifting(60.0, 0.1, 4400, rng);
  const auto heard = [&](int silence) {
    return associate(without(edges, [&](const MadeEdge& edge) {
      return (edge.turn >= 600 && edge.turn < 600 + silence);
    }));
  };
  for (const Revolution& revolution : heard(60).closed) {
    ASSERT_FALSE(revolution.count_sigma_turns) << revolution.number;
  }
  const auto closed = heard(3720).closed;
  const auto uncertain = std::ranges::find_if(
      closed, [](const Revolution& r) { return r.count_sigma_turns.has_value(); });
  const auto after = std::ranges::find_if(closed, [&](const Revolution& r) {
    return r.t_start > edges.at(4000 * kPulseChannels).pulse.t;
  });
  ASSERT_NE(after, closed.end());
  // Either the count is right, or its stated uncertainty is about its error.
  if (uncertain == closed.end()) {
    expect_every_edge_on_its_turn(
        {.closed = closed, .left_over = {}},
        without(edges, [](const MadeEdge& edge) { return edge.turn >= 600 && edge.turn < 4320; }));
  } else {
    EXPECT_GE(uncertain->number, 4310);
    EXPECT_LE(uncertain->number, 4330);
  }
}

TEST(Association, AYearOfSilenceStartsTheClockAfresh) {
  const auto edges = made({.noise_s = 1e-4});
  std::vector<Pulse> pulses = pulses_of(edges);
  const std::size_t first = pulses.size();
  for (std::size_t i = 0; i < first; ++i) {
    pulses.push_back({.t = shifted(pulses[i].t, 365.0 * 86400.0), .channel = pulses[i].channel});
  }
  const Association all = associate(pulses);
  EXPECT_LT(all.left_over.size(), 6U);
  EXPECT_TRUE(std::ranges::is_sorted(all.closed, {}, &Revolution::number));
  const auto year_on = std::ranges::find_if(
      all.closed, [&](const auto& r) { return r.t_start > shifted(kStart, 1e6); });
  ASSERT_NE(year_on, all.closed.end());
  ASSERT_TRUE(year_on->count_sigma_turns);
  EXPECT_GT(*year_on->count_sigma_turns, 0.5);
  EXPECT_GE(std::distance(year_on, all.closed.end()), 99);
}

}  // namespace spindrift::association_changes_test
