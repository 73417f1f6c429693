#include <gtest/gtest.h>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/time/time_span.h"

namespace spindrift::rate_step_test {

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kNoise_s = 1e-4;
constexpr double kPeriod_s = 1.0;

TEST(RateStep, EdgesOfANewRateAreACombOfTheirOwn) {
  RateStepDetector watch;
  for (int turn = 0; turn < 5; ++turn) {
    watch.add(later_by_s(kStart, turn * 1.0), true);
    EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
  }
  // The search starts after four wrong edges but needs six on the comb; the last good edge, where
  // the rate steps, is the first of these.
  for (int turn = 1; turn <= 4; ++turn) {
    watch.add(later_by_s(kStart, 4.0 + turn * 0.9), false);
    EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s)) << turn;
  }
  watch.add(later_by_s(kStart, 4.0 + 5 * 0.9), false);
  const auto comb = watch.new_pulse_train(kNoise_s, kPeriod_s);
  ASSERT_TRUE(comb);
  EXPECT_NEAR(comb->period_s, 0.9, 1e-9);

  watch.forget();
  watch.add(later_by_s(kStart, 4.0 + 6 * 0.9), false);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

TEST(RateStep, AnEdgeThatTheClockExpectsRaisesNoQuestion) {
  RateStepDetector watch;
  for (int turn = 0; turn < 8; ++turn) {
    watch.add(later_by_s(kStart, turn * 0.9), false);
  }
  ASSERT_TRUE(watch.new_pulse_train(kNoise_s, kPeriod_s));
  watch.add(later_by_s(kStart, 8 * 0.9), true);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

TEST(RateStep, StraysAmongGoodEdgesLeaveTheClockItsComb) {
  RateStepDetector watch;
  for (int turn = 0; turn < 5; ++turn) {
    watch.add(later_by_s(kStart, turn * 1.0), true);
    watch.add(later_by_s(kStart, turn * 1.0 + 0.13 + 0.07 * turn), false);
    EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s)) << turn;
  }
}

TEST(RateStep, ACombThatTheLastEdgeIsNotOnIsNoReason) {
  RateStepDetector watch;
  for (int turn = 0; turn < 8; ++turn) {
    watch.add(later_by_s(kStart, turn * 0.9), false);
  }
  watch.add(later_by_s(kStart, 7.4 * 0.9), false);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

/// After time stamps stepped back by a third of a turn, both trains lie on a comb of a third.
TEST(RateStep, ThinlyFilledTeethOfAFractionAreNoNewRate) {
  RateStepDetector watch;
  for (int turn = 0; turn < 9; ++turn) {
    watch.add(later_by_s(kStart, turn / 2 + (turn % 2 == 0 ? 0.0 : 1.0 / 3.0)), turn % 2 == 0);
  }
  watch.add(later_by_s(kStart, 4.0 + 1.0 / 3.0), false);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

TEST(RateStep, AThreefoldRateIsOne) {
  RateStepDetector watch;
  for (int turn = 0; turn < 9; ++turn) {
    watch.add(later_by_s(kStart, turn / 3.0), turn % 3 == 0);
  }
  watch.add(later_by_s(kStart, 10.0 / 3.0), false);
  const auto comb = watch.new_pulse_train(kNoise_s, kPeriod_s);
  ASSERT_TRUE(comb);
  EXPECT_NEAR(comb->period_s, 1.0 / 3.0, 1e-9);
}

TEST(RateStep, SpoiltEdgesAndGoodOnesThatShareAWideCombLeaveTheClockItsOwn) {
  RateStepDetector watch;
  int turn = 0;
  for (const double off_s : {0.0, 0.0, 0.0, -0.0017, 0.0016, 0.0, 0.0027, 0.0, -0.0050}) {
    watch.add(later_by_s(kStart, turn++ + off_s), off_s == 0.0);
    EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s)) << turn;
  }
}

TEST(RateStep, EverySecondTurnOfTheClockIsNoHalfRate) {
  RateStepDetector watch;
  for (int turn = 0; turn < 18; turn += 2) {
    watch.add(later_by_s(kStart, turn + (turn % 4 == 0 ? 0.0015 : 0.002)), false);
    EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s)) << turn;
  }
}

TEST(RateStep, AHalvedRateIsOne) {
  RateStepDetector watch;
  for (int turn = 0; turn < 9; ++turn) {
    watch.add(later_by_s(kStart, turn * 2.02), false);
  }
  const auto comb = watch.new_pulse_train(kNoise_s, kPeriod_s);
  ASSERT_TRUE(comb);
  EXPECT_NEAR(comb->period_s, 2.02, 1e-9);
}

}  // namespace spindrift::rate_step_test
