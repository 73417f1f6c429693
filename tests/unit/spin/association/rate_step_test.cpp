#include <utility>
#include <vector>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

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
  const auto comb = watch.new_pulse_train(kNoise_s, kPeriod_s).value();
  EXPECT_NEAR(comb.period_s, 0.9, 1e-9);

  watch.forget();
  watch.add(later_by_s(kStart, 4.0 + 6 * 0.9), false);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

struct Edge {
  double t_s;
  bool expected;
};

/// Returns edges at multiples of `every_s`; the clock expects those of every so many turns.
std::vector<Edge> train(int edges, double every_s, int expected_of) {
  std::vector<Edge> all;
  for (int i = 0; i < edges; ++i) {
    all.push_back({i * every_s, expected_of > 0 && i % expected_of == 0});
  }
  return all;
}

RateStepDetector after(const std::vector<Edge>& edges) {
  RateStepDetector watch;
  for (const auto& [t_s, expected] : edges) {
    watch.add(later_by_s(kStart, t_s), expected);
  }
  return watch;
}

TEST(RateStep, AnEdgeThatTheClockExpectsRaisesNoQuestion) {
  RateStepDetector watch = after(train(8, 0.9, 0));
  ASSERT_TRUE(watch.new_pulse_train(kNoise_s, kPeriod_s));
  watch.add(later_by_s(kStart, 8 * 0.9), true);
  EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s));
}

TEST(RateStep, ThreefoldAndHalvedRatesAreOne) {
  std::vector<Edge> threefold = train(9, 1.0 / 3.0, 3);
  threefold.push_back({10.0 / 3.0, false});
  for (const auto& [edges, period_s] :
       {std::pair{threefold, 1.0 / 3.0}, std::pair{train(9, 2.02, 0), 2.02}}) {
    const auto comb = after(edges).new_pulse_train(kNoise_s, kPeriod_s);
    ASSERT_TRUE(comb) << period_s;
    EXPECT_NEAR(comb->period_s, period_s, 1e-9);
  }
}

TEST(RateStep, WhatLeavesTheClockItsCombIsNone) {
  std::vector<Edge> strays_among_good;
  for (int turn = 0; turn < 5; ++turn) {
    strays_among_good.push_back({1.0 * turn, true});
    strays_among_good.push_back({turn + 0.13 + 0.07 * turn, false});
  }
  std::vector<Edge> spoilt_on_a_wide_comb;
  for (const double off_s : {0.0, 0.0, 0.0, -0.0017, 0.0016, 0.0, 0.0027, 0.0, -0.0050}) {
    spoilt_on_a_wide_comb.push_back(
        {static_cast<double>(spoilt_on_a_wide_comb.size()) + off_s, off_s == 0.0});
  }
  std::vector<Edge> every_second_turn;
  for (int turn = 0; turn < 18; turn += 2) {
    every_second_turn.push_back({turn + (turn % 4 == 0 ? 0.0015 : 0.002), false});
  }
  for (const auto& edges : {strays_among_good, spoilt_on_a_wide_comb, every_second_turn}) {
    RateStepDetector watch;
    for (const auto& [t_s, expected] : edges) {
      watch.add(later_by_s(kStart, t_s), expected);
      EXPECT_FALSE(watch.new_pulse_train(kNoise_s, kPeriod_s)) << t_s;
    }
  }
  std::vector<Edge> last_beside = train(8, 0.9, 0);
  last_beside.push_back({7.4 * 0.9, false});
  // After time stamps stepped back by a third of a turn, both trains lie on a comb of a third.
  std::vector<Edge> thinly_filled;
  for (int turn = 0; turn < 9; ++turn) {
    thinly_filled.push_back({turn / 2 + (turn % 2 == 0 ? 0.0 : 1.0 / 3.0), turn % 2 == 0});
  }
  thinly_filled.push_back({4.0 + 1.0 / 3.0, false});
  for (const auto& edges : {last_beside, thinly_filled}) {
    EXPECT_FALSE(after(edges).new_pulse_train(kNoise_s, kPeriod_s));
  }
}

}  // namespace spindrift::rate_step_test
