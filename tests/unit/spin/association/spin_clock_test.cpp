#include "pipelines/spin/association/spin_clock.h"

#include <cmath>

#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

namespace spindrift::spin_clock_test {

const TaiTime kStart = tai_from_ns(1'700'000'000'000'000'000);
constexpr double kPeriod_s = 0.6;
constexpr double kNoise_s = 1e-4;
constexpr DriftGate kOpen{.sigma = 1e6, .most = 1.0};

SpinClock clock_at(double phase_turns) {
  return SpinClock{{.t = kStart,
                    .phase_turns = phase_turns,
                    .period_s = kPeriod_s,
                    .period_sigma_s = 1e-3,
                    .sigma_s = kNoise_s}};
}

TEST(SpinClock, CountsTurnsAndFindsTheirTimes) {
  const SpinClock clock = clock_at(5.0);
  EXPECT_EQ(clock.phase_turns(kStart), 5.0);
  EXPECT_NEAR(clock.phase_turns(later_by_s(kStart, 10.0 * kPeriod_s)), 15.0, 1e-8);
  for (const double turns : {-3.0, 5.0, 7.25, 900.0}) {
    EXPECT_NEAR(clock.phase_turns(clock.t_of(turns)), turns, 1e-8);
  }
}

TEST(SpinClock, LearnsAnEvenDrift) {
  constexpr double kDrift_per_s2 = 0.3 * kFirstDrift_per_s2;
  SpinClock clock = clock_at(0.0);
  const double rate = 1.0 / kPeriod_s;
  constexpr int kTurns = 1000;
  for (int turn = 1; turn <= kTurns; ++turn) {
    // Solves rate t + drift t^2 / 2 = turn.
    const double t_s = 2.0 * turn / (rate + std::sqrt(rate * rate + 2.0 * kDrift_per_s2 * turn));
    ASSERT_TRUE(clock.follow(turn, later_by_s(kStart, t_s), kNoise_s, 0.0, kOpen).passed());
  }
  const TaiTime end = clock.t_of(kTurns);
  const double rate_then = rate + kDrift_per_s2 * elapsed_s(kStart, end);
  const SpinPeriod period = clock.period_at(end, 0.0);
  EXPECT_NEAR(period.period_s, 1.0 / rate_then, 3.0 * period.sigma_s);
  EXPECT_LT(period.sigma_s, 1e-5);
  EXPECT_NEAR(period.drift_per_s2, kDrift_per_s2, 0.1 * kDrift_per_s2);
}

TEST(SpinClock, ShiftPutsATurnLater) {
  SpinClock clock = clock_at(0.0);
  const TaiTime before = clock.t_of(20.0);
  clock.shift(20, 0.1, 0.0);
  EXPECT_NEAR(elapsed_s(before, clock.t_of(20.0)), 0.1 * kPeriod_s, 1e-8);
  clock.shift(20, 0.0, 0.02);
  EXPECT_NEAR(elapsed_s(before, clock.t_of(20.0)), 0.1 * kPeriod_s, 1e-8);
  EXPECT_NEAR(clock.period_s(), kPeriod_s / 0.98, 1e-9);
  clock.add_turns(7);
  EXPECT_NEAR(elapsed_s(before, clock.t_of(27.0)), 0.1 * kPeriod_s, 1e-8);
}

TEST(SpinClock, IsLessCertainAheadAndOnceLoosened) {
  SpinClock clock = clock_at(0.0);
  EXPECT_NEAR(clock.sigma_s(0.0, 0.0), kNoise_s, 1e-9);
  EXPECT_LT(clock.sigma_s(10.0, 0.0), clock.sigma_s(100.0, 0.0));
  EXPECT_LT(clock.sigma_s(100.0, 0.0), clock.sigma_s(100.0, 1e-2));
  const double before_s = clock.sigma_s(10.0, 0.0);
  clock.loosen(0.05, 0.0, 0.0);
  EXPECT_NEAR(clock.sigma_s(10.0, 0.0), std::hypot(before_s, 0.05 * kPeriod_s), 1e-9);
}

}  // namespace spindrift::spin_clock_test
