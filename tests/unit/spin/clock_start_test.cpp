#include "pipelines/spin/clock_start.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

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

}  // namespace
}  // namespace spindrift
