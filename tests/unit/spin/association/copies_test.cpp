#include "pipelines/spin/association/copies.h"

#include <algorithm>
#include <random>
#include <tuple>

#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

namespace spindrift::copies_test {

using enum PulseChannel;

constexpr double kPeriod_s = 1.0;

Pulse edge(double t_s, PulseChannel channel = Sun1) {
  return {.t = later_by_s(tai_from_ns(1'795'143'637'000'000'000), t_s), .channel = channel};
}

TEST(Copies, FollowTheFirstEdgeOfTheirChannelWithinATwentiethOfATurn) {
  Copies copies;
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_FALSE(copies.behind_first_s(edge(turn), kPeriod_s));
    // Copies are recognised from the third revolution on.
    EXPECT_EQ(copies.behind_first_s(edge(turn + 0.02), kPeriod_s).has_value(), turn == 2);
  }
  EXPECT_FALSE(copies.behind_first_s(edge(3.0), kPeriod_s));
  EXPECT_FALSE(copies.behind_first_s(edge(3.01, Sun2), kPeriod_s));
  // Times are rounded to nanoseconds.
  EXPECT_NEAR(copies.behind_first_s(edge(3.02), kPeriod_s).value(), 0.02, 2e-9);
  EXPECT_NEAR(copies.behind_first_s(edge(3.049), kPeriod_s).value(), 0.049, 2e-9);
  EXPECT_FALSE(copies.behind_first_s(edge(3.051), kPeriod_s));
}

TEST(Copies, AreUsualWhereMostOfTheLastRevolutionsBringThem) {
  Copies copies;
  for (int turn = 0; turn < 2; ++turn) {
    copies.behind_first_s(edge(turn), kPeriod_s);
    copies.behind_first_s(edge(turn + 0.005), kPeriod_s);
  }
  EXPECT_FALSE(copies.are_usual(Sun1)) << "two may be chance";
  copies.behind_first_s(edge(2.0), kPeriod_s);
  copies.behind_first_s(edge(2.005), kPeriod_s);
  EXPECT_TRUE(copies.are_usual(Sun1));
  EXPECT_TRUE(copies.are_usual(Sun2)) << "all channels that were heard have them";
  copies.behind_first_s(edge(2.1, Sun2), kPeriod_s);
  EXPECT_FALSE(copies.are_usual(Sun2)) << "half do";
  for (int turn = 3; turn < 11; ++turn) {
    copies.behind_first_s(edge(turn), kPeriod_s);
    EXPECT_TRUE(copies.are_usual(Sun1)) << turn;
  }
  copies.behind_first_s(edge(11.0), kPeriod_s);
  EXPECT_FALSE(copies.are_usual(Sun1)) << "one of the last ten revolutions";
}

TEST(Copies, AreNotUsualWhereHalfOfTheRevolutionsBringThem) {
  Copies copies;
  for (int turn = 0; turn < 20; ++turn) {
    copies.behind_first_s(edge(turn), kPeriod_s);
    if (turn % 2 == 1) {
      copies.behind_first_s(edge(turn + 0.005), kPeriod_s);
    }
    EXPECT_FALSE(copies.are_usual(Sun1)) << turn;
  }
}

/// The quartiles of normal delays are 1.35 sigma apart.
TEST(Copies, AreInAnyOrderWhereTheirDelayIsLessThanItsNoise) {
  constexpr double kNoise_s = 1e-4;
  for (const auto& [delay_s, jitter_s, apart, any_order] : {std::tuple{1e-9, 0.0, false, false},
                                                            {1e-9, 1e-4, true, true},
                                                            {5e-5, 1e-4, true, true},
                                                            {5e-4, 1e-4, true, false},
                                                            {0.005, 0.001, true, false}}) {
    SCOPED_TRACE(::testing::Message() << delay_s << " s, " << jitter_s << " s");
    std::mt19937_64 rng{320};
    std::normal_distribution<double> normal;
    Copies copies;
    for (int turn = 0; turn < 100; ++turn) {
      const double t_s = delay_s + jitter_s * normal(rng);
      copies.behind_first_s(edge(turn + std::min(0.0, t_s)), kPeriod_s);
      copies.behind_first_s(edge(turn + std::max(0.0, t_s)), kPeriod_s);
    }
    EXPECT_EQ(copies.are_apart(Sun1, kNoise_s), apart);
    EXPECT_EQ(copies.are_in_any_order(Sun1, kNoise_s), any_order);
  }
}

}  // namespace spindrift::copies_test
