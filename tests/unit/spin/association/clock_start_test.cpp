#include "pipelines/spin/association/clock_start.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::clock_start_test {

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

std::vector<PeriodNote> notes_of(const std::vector<double>& periods_s) {
  std::vector<PeriodNote> notes;
  TaiTime t = kStart;
  for (const double period_s : periods_s) {
    t = shifted(t, period_s);
    notes.push_back({.t_sun1 = t, .period_s = period_s});
  }
  return notes;
}

double period_s_of(const std::vector<double>& periods_s) {
  const auto start = start_clock(usual_config(), notes_of(periods_s), false);
  return start ? start->clock.period_s() : 0.0;
}

TEST(StartClock, ByEdgesIsNotMisledByStrayOnesNearAThirdOfATurn) {
  // Edges of a simulated pass, in turns; two strays are within half a percent of two thirds.
  constexpr double kTurn_s = 1.2349;
  const std::vector<double> turns = {0.0,    1.0,  2.0,  2.6613, 3.0,    3.1306, 4.0,
                                     4.6610, 5.0,  6.0,  7.0,    7.1238, 8.0,    9.0,
                                     10.0,   11.0, 12.0, 13.0,   14.0,   15.0};
  std::vector<Pulse> pulses;
  int started = 0;
  for (const double turn : turns) {
    pulses.push_back({.t = shifted(kStart, turn * kTurn_s), .channel = PulseChannel::Sun1});
    if (const auto start = start_clock(usual_config(), pulses, false)) {
      ++started;
      EXPECT_NEAR(start->clock.period_s(), kTurn_s, 1e-3 * kTurn_s) << turn;
    }
  }
  EXPECT_GT(started, 8);
}

/// Returns sun1 edges every `sun1_every_s` among the edges of four other channels at 1 s a turn.
std::vector<Pulse> among_others(double sun1_every_s) {
  std::vector<Pulse> pulses;
  for (double t_s = 0.0; t_s < 30.0; t_s += sun1_every_s) {
    pulses.push_back({.t = shifted(kStart, t_s), .channel = PulseChannel::Sun1});
  }
  for (int turn = 0; turn < 30; ++turn) {
    for (const auto& [channel, phase] : {std::pair{PulseChannel::Sun2, 0.1},
                                         {PulseChannel::NorthIn, 0.4},
                                         {PulseChannel::NorthOut, 0.5},
                                         {PulseChannel::SouthIn, 0.45}}) {
      pulses.push_back({.t = shifted(kStart, turn + phase), .channel = channel});
    }
  }
  std::ranges::sort(pulses);
  return pulses;
}

TEST(StartClock, ByEdgesTakesThePeriodThatMostChannelsAgreeOn) {
  for (const double sun1_every_s : {0.5, 1.0, 2.0}) {
    SCOPED_TRACE(sun1_every_s);
    std::vector<Pulse> pulses;
    std::optional<ClockStart> start;
    for (const Pulse& pulse : among_others(sun1_every_s)) {
      pulses.push_back(pulse);
      start = start_clock(usual_config(), pulses, false);
      if (start) {
        break;
      }
    }
    ASSERT_TRUE(start);
    // Times are rounded to nanoseconds.
    EXPECT_NEAR(start->clock.period_s(), 1.0, 1e-9);
    EXPECT_EQ(start->reference, sun1_every_s == 1.0 ? PulseChannel::Sun1 : PulseChannel::Sun2);
  }
}

TEST(StartClock, ByNotesTakesThePeriodOfThreeThatAgree) {
  EXPECT_DOUBLE_EQ(period_s_of({7.35, 7.35, 7.35}), 7.35);
  EXPECT_EQ(period_s_of({7.35, 7.35}), 0.0);
  EXPECT_EQ(period_s_of({7.35, 7.35, 9.2}), 0.0);
}

TEST(StartClock, ByNotesIsNotMisledByPeriodsOfSeveralTurns) {
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 7.35, 7.35, 7.35}), 7.35);
  EXPECT_DOUBLE_EQ(period_s_of({22.05, 14.7, 7.35, 22.05, 7.35, 22.05, 22.05, 7.35}), 7.35);
  // A single wrong short note does not divide the period.
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 7.35}), 14.7);
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 9.0, 9.0}), 14.7);
}

}  // namespace spindrift::testing::clock_start_test
