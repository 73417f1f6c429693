/// The nutation search on tilts computed from their formula.

#include "pipelines/spin/nutation/nutation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"

namespace spindrift::nutation_test {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::DoubleNear;
using ::testing::HasSubstr;

constexpr double kPeriod_s = 0.8;
constexpr double kSigma_rad = 0.05 * kRadPerDeg;

struct Channel {
  PulseChannel channel;
  double turns;
  Eigen::Vector2d phase_per_tilt;
};

const std::vector<Channel> kChannels = {{PulseChannel::Sun1, 0.0, {0.1, 0.2}},
                                        {PulseChannel::Sun2, 0.1, {-0.6, 0.8}},
                                        {PulseChannel::NorthIn, 0.4, {1.4, 0.3}},
                                        {PulseChannel::NorthOut, 0.6, {-1.1, -0.5}}};

/// Returns the rotation (real part about x) that tilts the body after this many turns.
using Tilt = std::function<std::complex<double>(double turns)>;

std::vector<UniformSpinResidual> tipped(const std::vector<Channel>& channels, int turns,
                                        const Tilt& tilt) {
  std::vector<UniformSpinResidual> residuals;
  for (int turn = 0; turn < turns; ++turn) {
    for (const auto& [channel, behind, slope] : channels) {
      const double at = turn + behind;
      const std::complex<double> tilt_rad = tilt(at);
      const double off_rad = slope.x() * tilt_rad.real() + slope.y() * tilt_rad.imag();
      residuals.push_back(
          {.channel = channel,
           .t_s = kPeriod_s * at,
           .turns = at,
           .off_rad = off_rad,
           .sigma_rad = kSigma_rad,
           .expected = {.phase_rad = 0.0,
                        .phase_per_rotation = {slope.x(), slope.y(), -1.0},
                        .phase_per_error = Eigen::Matrix<double, 1, kModelErrors>::Zero(),
                        .phase_per_bias = Eigen::Matrix<double, 1, kSensorBiases>::Zero()}});
    }
  }
  return residuals;
}

Tilt circle(double half_angle_rad, double per_turn, double phase_rad) {
  return [=](double turns) {
    return std::polar(half_angle_rad, 2.0 * std::numbers::pi * per_turn * turns + phase_rad);
  };
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

TEST(Nutation, OfAnExactCircleIsFoundExactly) {
  for (const double per_turn : {0.07, 0.37, 0.81, 1.24, 1.93}) {
    SCOPED_TRACE(per_turn);
    const auto search = find_nutation(tipped(kChannels, 300, circle(0.003, per_turn, 0.4))).value();
    ASSERT_TRUE(search.found);
    const FoundNutation& found = *search.found;
    EXPECT_NEAR(found.half_angle_rad.value, 0.003, 1e-8);
    EXPECT_NEAR(found.period_s.value / (kPeriod_s / per_turn), 1.0, 1e-6);
    EXPECT_NEAR(found.per_turn, per_turn, 1e-6);
    EXPECT_NEAR(found.growth_per_s.value, 0.0, 1e-7);
    // The rotation (1, 0) tilts the axis towards -90 deg.
    const double lean_rad =
        2.0 * std::numbers::pi * (per_turn * found.t_s / kPeriod_s - 0.25) + 0.4;
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
      find_nutation(
          noisy(tipped(kChannels, kTurns, circle(kHalfAngle_rad, 0.37, 0.4)), kSigma_rad, 9))
          .value()
          .found;
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->half_angle_rad.value, kHalfAngle_rad, 3.0 * found->half_angle_rad.sigma);
  EXPECT_NEAR(found->period_s.value, kPeriod_s / 0.37, 3.0 * found->period_s.sigma);
  EXPECT_LT(found->period_s.sigma, 1e-5);
}

TEST(Nutation, GrowsAsItDoes) {
  const double growth_per_s = std::log(2.0) / 400.0;
  const Tilt growing = [&](double turns) {
    return circle(0.003, 0.37, 0.0)(turns) * std::exp(growth_per_s * kPeriod_s * (turns - 250.0));
  };
  const auto found =
      find_nutation(noisy(tipped(kChannels, 500, growing), kSigma_rad, 1)).value().found;
  ASSERT_TRUE(found);
  EXPECT_GT(found->growth_per_s.value, 5.0 * found->growth_per_s.sigma);
  // The growth of 0.35 to each end is treated to first order; its square adds a small error.
  EXPECT_NEAR(found->growth_per_s.value / growth_per_s, 1.0,
              0.05 + 3.0 * found->growth_per_s.sigma / growth_per_s);
}

TEST(Nutation, SeenOnceATurnLeavesItsAliasesOpen) {
  const std::vector<Channel> one = {kChannels[2]};
  const auto found =
      find_nutation(noisy(tipped(one, 300, circle(0.003, 0.37, 0.4)), kSigma_rad, 2)).value().found;
  ASSERT_TRUE(found);
  std::vector<double> periods_s = found->other_periods_s;
  periods_s.push_back(found->period_s.value);
  for (const double per_turn : {0.37, 0.63, 1.37, 1.63}) {
    EXPECT_THAT(periods_s, Contains(DoubleNear(kPeriod_s / per_turn, 1e-3)));
  }
}

TEST(Nutation, IsNotFoundInNoiseHoweverItIsStated) {
  for (const double scale : {0.2, 1.0, 5.0}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const auto search = find_nutation(noisy(tipped(kChannels, 200, circle(0.0, 0.3, 0.0)),
                                              scale * kSigma_rad, seed))
                              .value();
      EXPECT_FALSE(search.found) << scale << ' ' << seed;
    }
  }
}

TEST(Nutation, HasTheSigmaOfTheScatterNotOfTheStatement) {
  const auto edges = tipped(kChannels, 300, circle(0.01, 0.37, 0.4));
  const auto quiet = find_nutation(noisy(edges, kSigma_rad, 3)).value();
  const auto loud = find_nutation(noisy(edges, 3.0 * kSigma_rad, 3)).value();
  EXPECT_NEAR(loud.found->half_angle_rad.sigma / quiet.found->half_angle_rad.sigma, 3.0, 0.1);
  EXPECT_NEAR(loud.detectable_rad / quiet.detectable_rad, 3.0, 0.1);
}

TEST(Nutation, IsNotFoundInEdgesThatAreWhereExpected) {
  const auto search = find_nutation(tipped(kChannels, 100, circle(0.0, 0.3, 0.0))).value();
  EXPECT_FALSE(search.found);
  EXPECT_EQ(search.false_alarm, 1.0);
  EXPECT_GT(search.detectable_rad, 0.0);
}

TEST(Nutation, ThatGoesRoundOnceATurnIsTakenForMisplacedSensors) {
  for (const double per_turn : {1.0, 2.0}) {
    EXPECT_FALSE(
        find_nutation(noisy(tipped(kChannels, 300, circle(0.01, per_turn, 0.4)), kSigma_rad, 4))
            .value()
            .found);
  }
}

TEST(Nutation, DoesNotDependOnTheOrderOfTheEdges) {
  auto edges = noisy(tipped(kChannels, 100, circle(0.003, 0.37, 0.4)), kSigma_rad, 5);
  const auto found = find_nutation(edges).value().found;
  std::shuffle(edges.begin(), edges.end(), std::mt19937_64{6});
  const auto shuffled = find_nutation(edges).value().found;
  EXPECT_EQ(found->period_s.value, shuffled->period_s.value);
  EXPECT_EQ(found->half_angle_rad.sigma, shuffled->half_angle_rad.sigma);
}

TEST(Nutation, SurvivesGapsAndLostEdges) {
  auto edges = noisy(tipped(kChannels, 600, circle(0.003, 0.37, 0.4)), kSigma_rad, 7);
  std::mt19937_64 rng{8};
  std::erase_if(edges, [&](const UniformSpinResidual& edge) {
    return std::bernoulli_distribution{0.3}(rng) || (edge.turns > 200.0 && edge.turns < 400.0);
  });
  const auto found = find_nutation(edges).value().found;
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->period_s.value, kPeriod_s / 0.37, 4.0 * found->period_s.sigma);
}

std::string error_of(const std::vector<UniformSpinResidual>& edges, ErrorCode code) {
  const auto search = find_nutation(edges);
  EXPECT_FALSE(search);
  EXPECT_EQ(search.error().code, code);
  return search ? "none" : search.error().message;
}

TEST(Nutation, RefusesWhatItCannotUse) {
  const auto edges = tipped(kChannels, 100, circle(0.003, 0.37, 0.4));
  auto infinite = edges;
  infinite[17].off_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of(infinite, ErrorCode::InvalidInput), HasSubstr("must be finite"));
  auto exact = edges;
  exact[5].sigma_rad = 0.0;
  EXPECT_THAT(error_of(exact, ErrorCode::InvalidInput), HasSubstr("sigma above 0"));
  EXPECT_THAT(error_of({}, ErrorCode::Unobservable), HasSubstr("0 edges"));
  EXPECT_THAT(error_of(tipped(kChannels, 15, circle(0.003, 0.37, 0.4)), ErrorCode::Unobservable),
              AllOf(HasSubstr("14.0 turns"), HasSubstr("20 turns at least")));
  const std::vector<Channel> blind = {{PulseChannel::Sun1, 0.0, {0.0, 0.0}}};
  EXPECT_THAT(error_of(tipped(blind, 100, circle(0.003, 0.37, 0.4)), ErrorCode::Unobservable),
              HasSubstr("by 0 sigmas"));
}

}  // namespace spindrift::nutation_test
