#include "pipelines/spin/association/clock_start.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/spinning_body.h"

namespace spindrift::clock_start_test {

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

/// One behind the other.
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
  const auto start = start_clock(testing::usual_config(), notes_of(periods_s), false);
  return start ? start->clock.period_s() : 0.0;
}

TEST(StartClock, ByEdgesIsNotMisledByStrayOnesNearAThirdOfATurn) {
  // Of a simulated pass, in turns: two stray edges within half a percent of two thirds.
  constexpr double kTurn_s = 1.2349;
  const std::vector<double> turns = {0.0,    1.0,  2.0,  2.6613, 3.0,    3.1306, 4.0,
                                     4.6610, 5.0,  6.0,  7.0,    7.1238, 8.0,    9.0,
                                     10.0,   11.0, 12.0, 13.0,   14.0,   15.0};
  std::vector<Pulse> pulses;
  int started = 0;
  for (const double turn : turns) {
    pulses.push_back({.t = shifted(kStart, turn * kTurn_s), .channel = PulseChannel::Sun1});
    if (const auto start = start_clock(testing::usual_config(), pulses, false)) {
      ++started;
      EXPECT_NEAR(start->clock.period_s(), kTurn_s, 1e-3 * kTurn_s) << turn;
    }
  }
  EXPECT_GT(started, 8);
}

TEST(StartClock, ByNotesTakesThePeriodOfThreeThatAgree) {
  EXPECT_DOUBLE_EQ(period_s_of({7.35, 7.35, 7.35}), 7.35);
  EXPECT_EQ(period_s_of({7.35, 7.35}), 0.0);
  EXPECT_EQ(period_s_of({7.35, 7.35, 9.2}), 0.0);
}

TEST(StartClock, ByNotesIsNotMisledByPeriodsOfSeveralTurns) {
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 7.35, 7.35, 7.35}), 7.35);
  EXPECT_DOUBLE_EQ(period_s_of({22.05, 14.7, 7.35, 22.05, 7.35, 22.05, 22.05, 7.35}), 7.35);
  // One false short note divides nothing.
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 7.35}), 14.7);
  EXPECT_DOUBLE_EQ(period_s_of({14.7, 14.7, 14.7, 9.0, 9.0}), 14.7);
}

}  // namespace spindrift::clock_start_test
