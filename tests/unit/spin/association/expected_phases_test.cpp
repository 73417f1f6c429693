#include "pipelines/spin/association/expected_phases.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::expected_phases_test {

using enum PulseChannel;

constexpr double kPeriod_s = 1.0;
constexpr std::size_t kFewest = 5;

class ExpectedPhasesTest : public ::testing::Test {
 protected:
  ExpectedPhasesTest() {
    phases_.set_period(kPeriod_s);
    phases_.define(Sun1, 0, 0.0);
  }
  /// Returns edges of `turns` turns from `first` on whose phase changes by `drift` each turn.
  static std::vector<double> counts(int turns, double phase, double drift = 0.0, int first = 0) {
    std::vector<double> counts;
    for (int turn = first; turn < first + turns; ++turn) {
      counts.push_back(turn + phase + drift * (turn - first));
    }
    return counts;
  }

  void learn_north_in() {
    if (!phases_.learn(NorthIn, counts(20, 0.3), kFewest, 0.0)) {
      throw std::runtime_error{"twenty edges of one phase are not learned"};
    }
  }

  SpinConfig config_ = usual_config();
  ExpectedPhases phases_{config_};
};

TEST_F(ExpectedPhasesTest, AChannelPlacedByDefinitionStaysThere) {
  phases_.define(Sun1, 3, 0.25);
  EXPECT_TRUE(phases_.knows(Sun1));
  EXPECT_FALSE(phases_.knows(Sun2));
  for (const double turn : {3.0, 10.0, 100.0}) {
    EXPECT_EQ(phases_.at(Sun1, turn), 0.25);
  }
  EXPECT_NEAR(phases_.phase_sigma(Sun1, 3.0), config_.noise.sun_s / kPeriod_s, 1e-15);
}

/// The allowance is an acceleration of 2e-6 rad/s^2 for the Earth, T^2 / (2 pi) of it in turns per
/// turn squared, and none for the Sun.
TEST_F(ExpectedPhasesTest, TheEarthWandersWithTheSquareOfThePeriod) {
  EXPECT_NEAR(earth_wander_turns(NorthIn, 1.0), 2e-6 / (2.0 * std::numbers::pi), 1e-18);
  EXPECT_NEAR(earth_wander_turns(SouthOut, 10.0) / earth_wander_turns(SouthOut, 2.0), 25.0, 1e-12);
  EXPECT_EQ(earth_wander_turns(Sun2, 1.0), earth_wander_turns(Sun2, 10.0));
}

TEST_F(ExpectedPhasesTest, LearnsPhaseAndDriftOfEvenEdges) {
  constexpr double kDrift = 1e-4;
  ASSERT_TRUE(phases_.learn(NorthIn, counts(30, 0.3, kDrift), kFewest, 0.0));
  // The prior of the drift, 2e-4 a turn, and what thirty edges of 5e-4 determine, 1e-5, share it:
  // 1/400 of the drift is lost, which is 1e-5 over thirty turns.
  EXPECT_NEAR(phases_.drift(NorthIn), kDrift, 0.02 * kDrift);
  EXPECT_NEAR(phases_.at(NorthIn, 15.0), 0.3 + 15.0 * kDrift, 5e-5);
  EXPECT_NEAR(phases_.at(NorthIn, 60.0), 0.3 + 60.0 * kDrift, 2e-4);
}

TEST_F(ExpectedPhasesTest, TheSigmaOfALearntPhaseIsThatOfItsScatter) {
  std::mt19937_64 rng{71};
  std::normal_distribution<double> noise{0.0, config_.noise.infrared_s / kPeriod_s};
  constexpr int kTrials = 200;
  double squares = 0.0;
  double sigma_squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    ExpectedPhases phases{config_};
    phases.set_period(kPeriod_s);
    std::vector<double> edges = counts(20, 0.3);
    for (double& count : edges) {
      count += noise(rng);
    }
    ASSERT_TRUE(phases.learn(NorthIn, edges, kFewest, 0.0));
    squares += std::pow(phases.at(NorthIn, 0.0) - 0.3, 2);
    sigma_squares += std::pow(phases.phase_sigma(NorthIn, 0.0), 2);
  }
  // At its end a line through n points is known to 2 sigma / sqrt(n); the drift's prior adds to it.
  EXPECT_LT(squares, 1.3 * sigma_squares);
  EXPECT_GT(squares, 0.2 * sigma_squares);
}

TEST_F(ExpectedPhasesTest, PhasesAboutAWholeTurnAreOnePlace) {
  std::vector<double> edges;
  for (int turn = 0; turn < 20; ++turn) {
    edges.push_back(turn + (turn % 2 == 0 ? 0.9999 : 1.0001));
  }
  ASSERT_TRUE(phases_.learn(NorthIn, edges, kFewest, 0.0));
  EXPECT_NEAR(std::remainder(phases_.at(NorthIn, 10.0), 1.0), 0.0, 5e-4);
}

TEST_F(ExpectedPhasesTest, EdgesAnywhereAreNotLearnt) {
  std::mt19937_64 rng{72};
  std::uniform_real_distribution<double> phase;
  int learnt = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> edges;
    for (int turn = 0; turn < 12; ++turn) {
      edges.push_back(turn + phase(rng));
    }
    learnt += ExpectedPhases{phases_}.learn(NorthIn, edges, kFewest, 0.0) ? 1 : 0;
  }
  EXPECT_EQ(learnt, 0);
}

/// Merges the edges of two places in each turn.
std::vector<double> both(std::vector<double> one, const std::vector<double>& other) {
  one.insert(one.end(), other.begin(), other.end());
  std::ranges::sort(one);
  return one;
}

TEST_F(ExpectedPhasesTest, OfTwoPlacesInATurnNothingIsLearnt) {
  for (const double apart : {0.1, 0.3, 0.5}) {
    SCOPED_TRACE(apart);
    const auto all = both(counts(12, 0.3), counts(12, 0.3 + apart));
    EXPECT_FALSE(phases_.learn(NorthIn, all, kFewest, 0.0));
    // Lost edges of either place do not change that.
    const auto most = both(counts(12, 0.3), counts(8, 0.3 + apart));
    EXPECT_FALSE(phases_.learn(NorthIn, most, kFewest, 0.0));
    ExpectedPhases strays{phases_};
    for (const double count : all) {
      EXPECT_FALSE(strays.stray(NorthIn, count, 0.0, 0.0)) << count;
    }
  }
}

TEST_F(ExpectedPhasesTest, OfTwoPlacesTheSunIsOnTheSideOfTheOtherSlit) {
  const double slit_turns = config_.sun_sensor.slit_separation_rad / (2.0 * std::numbers::pi);
  const auto all = both(counts(12, slit_turns - 0.1), counts(12, slit_turns + 0.4));
  ASSERT_TRUE(phases_.learn(Sun2, all, kFewest, 0.0));
  EXPECT_NEAR(phases_.at(Sun2, 10.0), slit_turns - 0.1, 1e-6);

  ExpectedPhases by_sun2{config_};
  by_sun2.set_period(kPeriod_s);
  by_sun2.set_reference(Sun2);
  by_sun2.define(Sun2, 0, slit_turns);
  const auto strays = both(counts(12, 0.1), counts(12, 0.6));
  ASSERT_TRUE(std::ranges::any_of(
      strays, [&](double count) { return by_sun2.stray(Sun1, count, 0.0, 0.0); }));
  EXPECT_NEAR(by_sun2.at(Sun1, 10.0), 0.1, 1e-6);
}

TEST_F(ExpectedPhasesTest, OnlyEdgesWithinTheGateAreFollowed) {
  learn_north_in();
  for (int turn = 20; turn < 25; ++turn) {
    EXPECT_TRUE(phases_.follow(NorthIn, turn, 0.3, 0.0).passed());
  }
  EXPECT_EQ(phases_.in_a_row(NorthIn), 5);
  EXPECT_FALSE(phases_.follow(NorthIn, 25, 0.3 + 1.01 * gate_turns(NorthIn), 0.0).passed());
  EXPECT_EQ(phases_.in_a_row(NorthIn), 0);
  EXPECT_NEAR(phases_.at(NorthIn, 26.0), 0.3, 1e-6);
}

TEST_F(ExpectedPhasesTest, StraysThatAgreeMoveAChannelAndOthersDoNot) {
  learn_north_in();
  bool moved = false;
  int strays = 0;
  while (!moved && strays < 9) {
    moved = phases_.stray(NorthIn, 20.0 + strays + 0.6, 0.0, 0.0);
    ++strays;
  }
  EXPECT_TRUE(moved);
  EXPECT_GE(strays, 3);
  EXPECT_NEAR(std::remainder(phases_.at(NorthIn, 25.0) - 0.6, 1.0), 0.0, 1e-4);
  const double place = phases_.at(NorthIn, 40.0);
  for (int i = 0; i < 9; ++i) {
    EXPECT_FALSE(phases_.stray(NorthIn, 30.0 + i + 0.1 * i, 0.0, 0.0));
  }
  EXPECT_EQ(phases_.at(NorthIn, 40.0), place);
}

TEST_F(ExpectedPhasesTest, ASilentChannelIsForgottenTheReferenceIsNot) {
  learn_north_in();
  for (int i = 0; i < 30; ++i) {
    phases_.end_revolution();
  }
  EXPECT_TRUE(phases_.knows(NorthIn));
  phases_.end_revolution();
  EXPECT_FALSE(phases_.knows(NorthIn));
  EXPECT_TRUE(phases_.knows(Sun1));
}

TEST_F(ExpectedPhasesTest, AClockSetLaterMakesEveryPhaseEarlier) {
  learn_north_in();
  const double before = phases_.at(NorthIn, 30.0);
  const double drift = phases_.drift(NorthIn);
  phases_.shift(20, 0.05, 1e-3);
  EXPECT_NEAR(phases_.at(NorthIn, 30.0), before - 0.05 - 10.0 * 1e-3, 1e-12);
  EXPECT_NEAR(phases_.drift(NorthIn), drift - 1e-3, 1e-15);
  EXPECT_NEAR(phases_.at(Sun1, 30.0), -0.05 - 10.0 * 1e-3, 1e-12);
}

TEST_F(ExpectedPhasesTest, ChannelsInterfereWhereTheirEdgesMeetAcrossTheTurnToo) {
  config_.screening.interference_s = 0.01;
  phases_ = ExpectedPhases{config_};
  phases_.set_period(kPeriod_s);
  phases_.define(Sun1, 0, 0.0);
  for (const auto& [phase, meet] : {std::pair{0.005, true}, std::pair{0.995, true},
                                    std::pair{0.05, false}, std::pair{0.5, false}}) {
    phases_.define(NorthIn, 0, phase);
    for (const auto& gap : {phases_.gap(Sun1, NorthIn, 1.0, 0.0).value(),
                            phases_.gap(NorthIn, Sun1, 1.0, 0.0).value()}) {
      EXPECT_NEAR(gap.gap_s, std::min(phase, 1.0 - phase) * kPeriod_s, 1e-12);
      EXPECT_EQ(gap.gap_s < gap.least_s, meet) << phase;
    }
  }
  EXPECT_FALSE(phases_.gap(Sun1, SouthIn, 1.0, 0.0));
}

TEST_F(ExpectedPhasesTest, TheLatestIsThatOfAllChannels) {
  EXPECT_EQ(phases_.latest(5.0), 0.0);
  phases_.define(SouthOut, 0, 0.8);
  phases_.define(NorthIn, 0, 0.3);
  EXPECT_EQ(phases_.latest(5.0), 0.8);
}

}  // namespace spindrift::testing::expected_phases_test
