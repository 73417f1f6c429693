/// The nutation search on tilts computed from their formula.

#include "pipelines/spin/nutation/nutation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/unit/spin/nutation/edges_off.h"

namespace spindrift::testing::nutation_test {

using ::testing::DoubleNear;

constexpr double kSigma_rad = 0.05 * kRadPerDeg;

std::vector<UniformSpinResidual> tipped(
    int turns, const Off& tilt, const std::vector<SteadyChannel>& channels = kSteadyChannels) {
  return edges_off(channels, turns, tilt, kSigma_rad);
}

std::vector<UniformSpinResidual> noisy(std::vector<UniformSpinResidual> residuals, double sigma_rad,
                                       unsigned seed) {
  std::mt19937_64 rng{seed};
  std::normal_distribution<double> normal{0.0, sigma_rad};
  for (UniformSpinResidual& residual : residuals) {
    residual.off_rad += normal(rng);
  }
  return residuals;
}

NutationSearch searched(int turns, const Off& tilt, double sigma_rad, unsigned seed) {
  return find_nutation(noisy(tipped(turns, tilt), sigma_rad, seed)).value();
}

TEST(Nutation, OfAnExactCircleIsFoundExactly) {
  for (const double per_turn : {0.07, 0.37, 0.81, 1.24, 1.93}) {
    SCOPED_TRACE(per_turn);
    const auto search = find_nutation(tipped(300, off_by_circle(0.003, per_turn, 0.4))).value();
    const FoundNutation& found = search.found.value();
    EXPECT_NEAR(found.half_angle_rad.value, 0.003, 1e-8);
    EXPECT_NEAR(found.period_s.value / (kSteadyPeriod_s / per_turn), 1.0, 1e-6);
    EXPECT_NEAR(found.per_turn, per_turn, 1e-6);
    EXPECT_NEAR(found.growth_per_s.value, 0.0, 1e-7);
    // The rotation (1, 0) tilts the axis towards -90 deg.
    const double lean_rad =
        2.0 * std::numbers::pi * (per_turn * found.t_s / kSteadyPeriod_s - 0.25) + 0.4;
    EXPECT_NEAR(std::remainder(found.lean_azimuth_rad.value - lean_rad, 2.0 * std::numbers::pi),
                0.0, 1e-4);
    EXPECT_TRUE(found.other_periods_s.empty());
    EXPECT_LT(search.false_alarm, 1e-100);
  }
}

TEST(Nutation, OfADayAtAHundredRpmIsFound) {
  constexpr int kTurns = 144'000;
  constexpr double kHalfAngle_rad = 2e-5;
  const auto found =
      searched(kTurns, off_by_circle(kHalfAngle_rad, 0.37, 0.4), kSigma_rad, 9).found.value();
  EXPECT_NEAR(found.half_angle_rad.value, kHalfAngle_rad, 3.0 * found.half_angle_rad.sigma);
  EXPECT_NEAR(found.period_s.value, kSteadyPeriod_s / 0.37, 3.0 * found.period_s.sigma);
  EXPECT_LT(found.period_s.sigma, 1e-5);
}

TEST(Nutation, GrowsAsItDoes) {
  const double growth_per_s = std::log(2.0) / 400.0;
  const Off growing = [&](const SteadyChannel& channel, double turns) {
    return off_by_circle(0.003, 0.37, 0.0)(channel, turns) *
           std::exp(growth_per_s * kSteadyPeriod_s * (turns - 250.0));
  };
  const auto found = searched(500, growing, kSigma_rad, 1).found.value();
  EXPECT_GT(found.growth_per_s.value, 5.0 * found.growth_per_s.sigma);
  // The growth of 0.35 to each end is treated to first order; its square adds a small error.
  EXPECT_NEAR(found.growth_per_s.value / growth_per_s, 1.0,
              0.05 + 3.0 * found.growth_per_s.sigma / growth_per_s);
}

TEST(Nutation, SeenOnceATurnLeavesItsAliasesOpen) {
  const auto found =
      find_nutation(
          noisy(tipped(300, off_by_circle(0.003, 0.37, 0.4), {kSteadyChannels[2]}), kSigma_rad, 2))
          .value()
          .found.value();
  std::vector<double> periods_s = found.other_periods_s;
  periods_s.push_back(found.period_s.value);
  for (const double per_turn : {0.37, 0.63, 1.37, 1.63}) {
    EXPECT_THAT(periods_s, Contains(DoubleNear(kSteadyPeriod_s / per_turn, 1e-3)));
  }
}

TEST(Nutation, IsNotFoundInNoiseHoweverItIsStated) {
  for (const double scale : {0.2, 1.0, 5.0}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const auto search = searched(200, off_by_circle(0.0, 0.3, 0.0), scale * kSigma_rad, seed);
      EXPECT_FALSE(search.found) << scale << ' ' << seed;
    }
  }
}

TEST(Nutation, HasTheSigmaOfTheScatterNotOfTheStatement) {
  const auto edges = tipped(300, off_by_circle(0.01, 0.37, 0.4));
  const auto quiet = find_nutation(noisy(edges, kSigma_rad, 3)).value();
  const auto loud = find_nutation(noisy(edges, 3.0 * kSigma_rad, 3)).value();
  EXPECT_NEAR(loud.found->half_angle_rad.sigma / quiet.found->half_angle_rad.sigma, 3.0, 0.1);
  EXPECT_NEAR(loud.detectable_rad / quiet.detectable_rad, 3.0, 0.1);
}

TEST(Nutation, IsNotFoundInEdgesThatAreWhereExpected) {
  const auto search = find_nutation(tipped(100, off_by_circle(0.0, 0.3, 0.0))).value();
  EXPECT_FALSE(search.found);
  EXPECT_EQ(search.false_alarm, 1.0);
  EXPECT_GT(search.detectable_rad, 0.0);
}

TEST(Nutation, ThatGoesRoundOnceATurnIsTakenForMisplacedSensors) {
  for (const double per_turn : {1.0, 2.0}) {
    EXPECT_FALSE(searched(300, off_by_circle(0.01, per_turn, 0.4), kSigma_rad, 4).found);
  }
}

TEST(Nutation, DoesNotDependOnTheOrderOfTheEdges) {
  auto edges = noisy(tipped(100, off_by_circle(0.003, 0.37, 0.4)), kSigma_rad, 5);
  const auto found = find_nutation(edges).value().found;
  std::ranges::shuffle(edges, std::mt19937_64{6});
  const auto shuffled = find_nutation(edges).value().found;
  EXPECT_EQ(found->period_s.value, shuffled->period_s.value);
  EXPECT_EQ(found->half_angle_rad.sigma, shuffled->half_angle_rad.sigma);
}

TEST(Nutation, SurvivesGapsAndLostEdges) {
  auto edges = noisy(tipped(600, off_by_circle(0.003, 0.37, 0.4)), kSigma_rad, 7);
  std::mt19937_64 rng{8};
  std::erase_if(edges, [&](const UniformSpinResidual& edge) {
    return std::bernoulli_distribution{0.3}(rng) || (edge.turns > 200.0 && edge.turns < 400.0);
  });
  const auto found = find_nutation(edges).value().found.value();
  EXPECT_NEAR(found.period_s.value, kSteadyPeriod_s / 0.37, 4.0 * found.period_s.sigma);
}

TEST(Nutation, RefusesWhatItCannotUse) {
  using enum ErrorCode;
  const Off tilt = off_by_circle(0.003, 0.37, 0.4);
  const auto edges = tipped(100, tilt);
  auto infinite = edges;
  infinite[17].off_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(find_nutation(infinite), IsRefused(InvalidInput, HasSubstr("must be finite")));
  auto exact = edges;
  exact[5].sigma_rad = 0.0;
  EXPECT_THAT(find_nutation(exact), IsRefused(InvalidInput, HasSubstr("sigma above 0")));
  EXPECT_THAT(find_nutation({}), IsRefused(Unobservable, HasSubstr("0 edges")));
  EXPECT_THAT(
      find_nutation(tipped(15, tilt)),
      IsRefused(Unobservable, AllOf(HasSubstr("14.0 turns"), HasSubstr("20 turns at least"))));
  EXPECT_THAT(find_nutation(tipped(100, tilt, {{PulseChannel::Sun1, 0.0, {0.0, 0.0}}})),
              IsRefused(Unobservable, HasSubstr("by 0 sigmas")));
}

}  // namespace spindrift::testing::nutation_test
