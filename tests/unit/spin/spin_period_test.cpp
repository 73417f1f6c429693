#include "pipelines/spin/spin_period.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace spindrift {
namespace {

constexpr double kEdgeSigma_s = 1e-4;
constexpr double kCandidateSigma_s = std::numbers::sqrt2 * kEdgeSigma_s;
// An edge is rounded to 1 ns.
constexpr double kRounding_s = 1e-9;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

TaiTime after(double t_s) { return shifted(kStart, t_s); }

SpinPeriodWindow window_of(int length) {
  return SpinPeriodWindow{{.window = length, .sigma = 3.0, .interference_s = 0.0}, kEdgeSigma_s};
}

TEST(SpinPeriodWindow, KnowsNothingBeforeTheFirstCandidate) {
  EXPECT_FALSE(window_of(100).period());
  EXPECT_EQ(window_of(100).size(), 0U);
}

TEST(SpinPeriodWindow, OneIntervalIsThePeriod) {
  SpinPeriodWindow window = window_of(100);
  const PeriodCandidate candidate = window.add(after(0.0), after(0.75), 1);
  EXPECT_TRUE(candidate.accepted);
  EXPECT_NEAR(candidate.period_s, 0.75, kRounding_s);
  EXPECT_DOUBLE_EQ(candidate.sigma_s, kCandidateSigma_s);
  EXPECT_NEAR(window.period().value().period_s, 0.75, kRounding_s);
  EXPECT_DOUBLE_EQ(window.period().value().sigma_s, kCandidateSigma_s);
}

TEST(SpinPeriodWindow, AGapOfSeveralTurnsIsDividedByThem) {
  SpinPeriodWindow window = window_of(100);
  const PeriodCandidate candidate = window.add(after(0.0), after(3.0), 4);
  EXPECT_NEAR(candidate.period_s, 0.75, kRounding_s);
  EXPECT_DOUBLE_EQ(candidate.sigma_s, kCandidateSigma_s / 4.0);
  EXPECT_DOUBLE_EQ(window.period().value().sigma_s, kCandidateSigma_s / 4.0);
}

TEST(SpinPeriodWindow, NoiseOfTheEdgesBetweenCancels) {
  SpinPeriodWindow window = window_of(100);
  window.add(after(0.0), after(1.0001), 1);
  window.add(after(1.0001), after(1.9999), 1);
  window.add(after(1.9999), after(3.0), 1);
  EXPECT_NEAR(window.period().value().period_s, 1.0, kRounding_s);
}

TEST(SpinPeriodWindow, AWrongIntervalIsRefusedAndLeavesThePeriodAlone) {
  SpinPeriodWindow window = window_of(100);
  for (int turn = 0; turn < 30; ++turn) {
    window.add(after(turn), after(turn + 1), 1);
  }
  const PeriodCandidate candidate = window.add(after(30.0), after(31.004), 1);
  EXPECT_FALSE(candidate.accepted);
  EXPECT_NEAR(candidate.period_s, 1.004, kRounding_s);
  EXPECT_NEAR(window.period().value().period_s, 1.0, kRounding_s);
}

TEST(SpinPeriodWindow, KeepsUpWithARateThatDrifts) {
  SpinPeriodWindow window = window_of(100);
  // Turn k takes 1 + 1e-6 k seconds.
  const auto edge = [](double turn) { return after(turn + 0.5e-6 * turn * turn); };
  for (int turn = 0; turn < 250; ++turn) {
    window.add(edge(turn), edge(turn + 1), 1);
  }
  EXPECT_NEAR(window.period().value().period_s, 1.0 + 250e-6, 0.1e-6);
}

TEST(SpinPeriodWindow, ForgetsWhatLiesBeforeTheWindow) {
  SpinPeriodWindow window = window_of(20);
  double t_s = 0.0;
  for (int turn = 0; turn < 20; ++turn, t_s += 1.0) {
    window.add(after(t_s), after(t_s + 1.0), 1);
  }
  for (int turn = 0; turn < 40; ++turn, t_s += 1.1) {
    window.add(after(t_s), after(t_s + 1.1), 1);
  }
  EXPECT_EQ(window.size(), 20U);
  EXPECT_NEAR(window.period().value().period_s, 1.1, kRounding_s);
}

TEST(SpinPeriodWindow, FollowsAChangeOfRateOnceItIsTheMajority) {
  SpinPeriodWindow window = window_of(20);
  double t_s = 0.0;
  for (int turn = 0; turn < 20; ++turn, t_s += 1.0) {
    window.add(after(t_s), after(t_s + 1.0), 1);
  }
  EXPECT_FALSE(window.add(after(t_s), after(t_s + 1.1), 1).accepted);
  PeriodCandidate last{};
  for (int turn = 0; turn < 11; ++turn) {
    t_s += 1.1;
    last = window.add(after(t_s), after(t_s + 1.1), 1);
  }
  EXPECT_TRUE(last.accepted);
}

TEST(SpinPeriodWindow, SigmaIsTheScatterOfThePeriod) {
  constexpr int kTrials = 1000;
  constexpr int kTurns = 60;
  constexpr double kPeriod_s = 0.6;
  std::mt19937_64 rng{21};
  std::normal_distribution<double> noise{0.0, kEdgeSigma_s};
  double squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    SpinPeriodWindow window = window_of(100);
    TaiTime before = after(noise(rng));
    std::int64_t turns = 1;
    for (int turn = 1; turn <= kTurns; ++turn, ++turns) {
      const TaiTime edge = after(turn * kPeriod_s + noise(rng));
      if (window.add(before, edge, turns).accepted) {  // As the clock of association does.
        before = edge;
        turns = 0;
      }
    }
    const SpinPeriod period = window.period().value();
    squares += std::pow((period.period_s - kPeriod_s) / period.sigma_s, 2);
  }
  // Chi-square with 1000 degrees of freedom, standard deviation sqrt(2000); four of them. Sigma is
  // the greater of the scatter seen and the scatter stated, which makes the square 9 % too small:
  // the scatter of 60 such candidates, neighbours correlated by -1/2, is known to 11 %.
  constexpr double kSpread = 4.0 * 44.7;
  EXPECT_LT(squares, kTrials + kSpread);
  EXPECT_GT(squares, 0.91 * kTrials - kSpread);
}

}  // namespace
}  // namespace spindrift
