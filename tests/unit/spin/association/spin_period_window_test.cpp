#include <numbers>

#include "pipelines/spin/association/period_intervals.h"
#include "tests/support/matchers.h"

namespace spindrift::spin_period_window_test {

constexpr double kEdgeSigma_s = 1e-4;
constexpr double kCandidateSigma_s = std::numbers::sqrt2 * kEdgeSigma_s;
// An edge is rounded to 1 ns.
constexpr double kRounding_s = 1e-9;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

TaiTime after(double t_s) { return shifted(kStart, t_s); }

SpinPeriodWindow window_of(int length) {
  return SpinPeriodWindow{{.window = length, .sigma = 3.0, .interference_s = 0.0}, kEdgeSigma_s};
}

TEST(SpinPeriodWindow, AGapOfSeveralTurnsIsDividedByThem) {
  SpinPeriodWindow window = window_of(100);
  const PeriodCandidate candidate = window.judge(after(0.0), after(3.0), 4, 0.75);
  EXPECT_FALSE(candidate.rejected_by);
  EXPECT_NEAR(candidate.period_s, 0.75, kRounding_s);
  EXPECT_DOUBLE_EQ(candidate.sigma_s, kCandidateSigma_s / 4.0);
  const PeriodCandidate refused = window.refused(after(0.0), after(3.0), 4, Rejection::Phase);
  EXPECT_EQ(refused.rejected_by, Rejection::Phase);
  EXPECT_NEAR(refused.period_s, 0.75, kRounding_s);
  EXPECT_DOUBLE_EQ(refused.sigma_s, kCandidateSigma_s / 4.0);
  EXPECT_EQ(window.size(), 1U);
}

TEST(SpinPeriodWindow, RefusesAWrongInterval) {
  SpinPeriodWindow window = window_of(100);
  for (int turn = 0; turn < 30; ++turn) {
    EXPECT_FALSE(window.judge(after(turn), after(turn + 1), 1, 1.0).rejected_by);
  }
  const PeriodCandidate candidate = window.judge(after(30.0), after(31.004), 1, 1.0);
  EXPECT_EQ(candidate.rejected_by, Rejection::Period);
  EXPECT_NEAR(candidate.period_s, 1.004, kRounding_s);
}

TEST(SpinPeriodWindow, ADriftOfTheRateHidesNoWrongInterval) {
  SpinPeriodWindow window = window_of(100);
  // Turn k takes 1 + 1e-3 k seconds: the window spans a tenth of the period.
  const auto edge = [](double turn) { return after(turn + 0.5e-3 * turn * turn); };
  const auto expected_s = [](double turn) { return 1.0 + 1e-3 * (turn + 0.5); };
  for (int turn = 0; turn < 150; ++turn) {
    EXPECT_FALSE(window.judge(edge(turn), edge(turn + 1), 1, expected_s(turn)).rejected_by);
  }
  const TaiTime late = shifted(edge(151), 0.004);
  EXPECT_TRUE(window.judge(edge(150), late, 1, expected_s(150)).rejected_by);
}

TEST(SpinPeriodWindow, WhatAllIntervalsShareRefusesNone) {
  SpinPeriodWindow window = window_of(100);
  for (int turn = 0; turn < 30; ++turn) {
    EXPECT_TRUE(!window.judge(after(turn), 1.0, 1.02).rejected_by || turn == 0);
  }
}

TEST(SpinPeriodWindow, ForgetsWhatLiesBeforeTheWindow) {
  SpinPeriodWindow window = window_of(20);
  for (int turn = 0; turn < 60; ++turn) {
    window.judge(after(turn), after(turn + 1), 1, 1.0);
  }
  EXPECT_EQ(window.size(), 20U);
}

TEST(SpinPeriodWindow, FollowsAChangeOfRateOnceItIsTheMajority) {
  SpinPeriodWindow window = window_of(20);
  double t_s = 0.0;
  for (int turn = 0; turn < 20; ++turn, t_s += 1.0) {
    window.judge(after(t_s), after(t_s + 1.0), 1, 1.0);
  }
  EXPECT_TRUE(window.judge(after(t_s), after(t_s + 1.1), 1, 1.0).rejected_by);
  PeriodCandidate last{};
  for (int turn = 0; turn < 11; ++turn) {
    t_s += 1.1;
    last = window.judge(after(t_s), after(t_s + 1.1), 1, 1.0);
  }
  EXPECT_FALSE(last.rejected_by);
}

}  // namespace spindrift::spin_period_window_test
