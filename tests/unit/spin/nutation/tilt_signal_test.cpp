#include "pipelines/spin/nutation/tilt_signal.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/unit/spin/nutation/edges_off.h"

namespace spindrift::testing::tilt_signal_test {

using Eigen::VectorXd;

/// Returns a different parabola for each channel.
double parabola_rad(const SteadyChannel& channel, double turns) {
  const double x = turns / 100.0;
  return channel.per_tilt.x() + (0.3 - channel.behind_turns) * x + channel.per_tilt.y() * x * x;
}

TEST(TiltSignal, OfNothingIsEmpty) {
  const TiltSignal signal{{}};
  EXPECT_EQ(signal.edges(), 0);
  EXPECT_EQ(signal.freedom(), 0.0);
}

TEST(TiltSignal, CountsTurnsFromTheEdgeInTheMiddle) {
  const auto residuals = edges_off(kSteadyChannels, 101, off_by_noise(kSteadySigma_rad, 1));
  const TiltSignal signal{residuals};
  ASSERT_EQ(signal.edges(), 404);
  EXPECT_NEAR(signal.spin_period_s(), kSteadyPeriod_s, 1e-12);
  EXPECT_NEAR(signal.turns_in_stretch(), 100.0, 1e-12);
  // The rows are sorted by channel, then by turn.
  Eigen::Index i = 0;
  for (const SteadyChannel& channel : kSteadyChannels) {
    for (int turn = 0; turn < 101; ++turn, ++i) {
      const double behind_middle_s =
          kSteadyPeriod_s * (turn + channel.behind_turns) - signal.middle_s();
      EXPECT_NEAR(signal.turns()[i], behind_middle_s / kSteadyPeriod_s, 1e-9);
      EXPECT_NEAR(signal.per_tilt()[i].real(), channel.per_tilt.x() / kSteadySigma_rad, 1e-9);
      EXPECT_NEAR(signal.per_tilt()[i].imag(), channel.per_tilt.y() / kSteadySigma_rad, 1e-9);
    }
  }
  EXPECT_EQ(signal.turns().cwiseAbs().minCoeff(), 0.0);
  EXPECT_NEAR(signal.turns().mean(), 0.0, 0.5);
}

TEST(TiltSignal, DoesNotDependOnTheOrderOfTheResiduals) {
  auto residuals = edges_off(kSteadyChannels, 100, off_by_noise(kSteadySigma_rad, 2));
  const TiltSignal signal{residuals};
  std::ranges::shuffle(residuals, std::mt19937_64{3});
  const TiltSignal shuffled{residuals};
  EXPECT_EQ(shuffled.off(), signal.off());
  EXPECT_EQ(shuffled.turns(), signal.turns());
  EXPECT_EQ(shuffled.per_tilt(), signal.per_tilt());
  EXPECT_EQ(shuffled.middle_s(), signal.middle_s());
}

TEST(TiltSignal, LeavesOutAStretchOfFewerThanTwelveEdges) {
  const auto first_of = [](int edges) {
    auto residuals = edges_off(kSteadyChannels, 50, off_by_noise(kSteadySigma_rad, 4));
    int seen = 0;
    std::erase_if(residuals, [&](const UniformSpinResidual& residual) {
      return residual.channel == PulseChannel::Sun2 && ++seen > edges;
    });
    return TiltSignal{residuals};
  };
  EXPECT_EQ(first_of(11).edges(), 150);
  EXPECT_EQ(first_of(11).freedom(), 150.0 - 3.0 * 4.0);
  EXPECT_EQ(first_of(12).edges(), 162);
  EXPECT_EQ(first_of(12).freedom(), 162.0 - 4.0 * 4.0);
}

TEST(TiltSignal, HasNothingOfAParabolaOfEachChannel) {
  const TiltSignal signal{edges_off(kSteadyChannels, 700, parabola_rad)};
  EXPECT_LT(signal.off().cwiseAbs().maxCoeff() * kSteadySigma_rad, 1e-9);
}

TEST(TiltSignal, HasNothingOfWhatAnErrorOfTheModelDoes) {
  auto residuals = edges_off(kSteadyChannels, 300, parabola_rad);
  for (UniformSpinResidual& residual : residuals) {
    // The slope grows as it does where a chord becomes narrow.
    residual.expected.phase_per_error[NorthLimb] = 1.0 / std::sqrt(310.0 - residual.turns);
    residual.off_rad += 0.01 * residual.expected.phase_per_error[NorthLimb];
  }
  EXPECT_LT(TiltSignal{residuals}.off().cwiseAbs().maxCoeff() * kSteadySigma_rad, 1e-9);
}

TEST(TiltSignal, HasParabolasOfTheirOwnEveryTenMinutes) {
  // 1600 turns are 1280 s, which gives three stretches of 533 turns.
  const Off kinked = [](const SteadyChannel& channel, double turns) {
    const double stretch = std::floor((turns - channel.behind_turns) / 1599.0 * 3.0);
    return parabola_rad(channel, turns) * (stretch == 1.0 ? -2.0 : 1.0);
  };
  const TiltSignal signal{edges_off(kSteadyChannels, 1600, kinked)};
  EXPECT_EQ(signal.freedom(), 4.0 * 1600.0 - 4.0 * 12.0);
  EXPECT_NEAR(signal.turns_in_stretch(), 533.0, 1.0);
  EXPECT_LT(signal.off().cwiseAbs().maxCoeff() * kSteadySigma_rad, 1e-8);
}

TEST(TiltSignal, TakingOutSlowChangesIsAProjection) {
  const TiltSignal signal{edges_off(kSteadyChannels, 200, off_by_noise(kSteadySigma_rad, 5))};
  Eigen::MatrixX2d columns(signal.edges(), 2);
  std::mt19937_64 rng{6};
  std::normal_distribution<double> normal;
  for (double& value : columns.reshaped()) {
    value = normal(rng);
  }
  Eigen::MatrixXd once = columns;
  signal.take_out_slow_changes(once);
  Eigen::MatrixXd twice = once;
  signal.take_out_slow_changes(twice);
  EXPECT_LT((twice - once).norm(), 1e-12 * once.norm());
  // The projection is symmetric, so the remainder is orthogonal to what is removed.
  EXPECT_NEAR(once.col(0).dot(columns.col(1)), columns.col(0).dot(once.col(1)), 1e-9);
  EXPECT_NEAR(once.col(0).dot(columns.col(0) - once.col(0)), 0.0, 1e-9);
  EXPECT_GT((columns - once).norm(), 1.0);
}

/// The share of unit noise that remains is the number of degrees of freedom.
TEST(TiltSignal, HasOneSquareForEachDegreeOfFreedom) {
  double squares = 0.0;
  double freedom = 0.0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const TiltSignal signal{edges_off(kSteadyChannels, 13, off_by_noise(kSteadySigma_rad, seed))};
    squares += signal.off().squaredNorm();
    freedom += signal.freedom();
  }
  EXPECT_NEAR(squares / freedom, 1.0, 5.0 * std::sqrt(2.0 / freedom));
}

/// The parameter is the number of cycles in a turn.
class Circle : public ::testing::TestWithParam<double> {
 protected:
  static constexpr double kSize_rad = 2e-3;
  static constexpr double kFirst_rad = 0.4;
  static std::vector<UniformSpinResidual> tipped() {
    return edges_off(kSteadyChannels, 300, off_by_circle(kSize_rad, GetParam(), kFirst_rad));
  }
  /// Returns the direction of the rotation at the middle of the pass.
  static double towards_rad(const TiltSignal& signal) {
    return kTurn_rad * GetParam() * signal.middle_s() / kSteadyPeriod_s + kFirst_rad;
  }
};

TEST_P(Circle, IsTheSumOfItsPatternTimesItsSizeAndDirection) {
  const TiltSignal signal{tipped()};
  Eigen::MatrixXd pattern = signal.pattern(GetParam());
  signal.take_out_slow_changes(pattern);
  const Eigen::Vector2d found = pattern.colPivHouseholderQr().solve(signal.off());
  EXPECT_LT((signal.off() - pattern * found).norm(), 1e-9 * signal.off().norm());
  EXPECT_NEAR(found.x(), kSize_rad * std::cos(towards_rad(signal)), 1e-9);
  EXPECT_NEAR(found.y(), kSize_rad * std::sin(towards_rad(signal)), 1e-9);
}

TEST_P(Circle, IsOfOneSizeInWhateverFrame) {
  constexpr double kTurned_rad = 1.1;
  const TiltSignal signal{tipped()};
  std::vector<SteadyChannel> turned = kSteadyChannels;
  for (SteadyChannel& channel : turned) {
    channel.per_tilt = Eigen::Rotation2Dd{kTurned_rad} * channel.per_tilt;
  }
  // The same edges in a rotated frame.
  auto residuals = tipped();
  const auto slopes = edges_off(turned, 300, [](const SteadyChannel&, double) { return 0.0; });
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    residuals[i].expected = slopes[i].expected;
  }
  Eigen::MatrixXd pattern = TiltSignal{residuals}.pattern(GetParam());
  signal.take_out_slow_changes(pattern);
  const Eigen::Vector2d found = pattern.colPivHouseholderQr().solve(signal.off());
  EXPECT_NEAR(found.norm(), kSize_rad, 1e-9);
  EXPECT_NEAR(std::remainder(std::atan2(found.y(), found.x()) - towards_rad(signal) - kTurned_rad,
                             kTurn_rad),
              0.0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(TiltSignal, Circle, ::testing::Values(-0.24, 0.07, 0.37, 1.24, 1.93));

TEST(TiltSignal, WeighsAChannelByHowFarItsEdgesScatter) {
  std::mt19937_64 rng{7};
  std::normal_distribution<double> normal{0.0, kSteadySigma_rad};
  TiltSignal signal{edges_off(kSteadyChannels, 4000, [&](const SteadyChannel& channel, double) {
    return (channel.channel == PulseChannel::Sun2 ? 3.0 : 0.5) * normal(rng);
  })};
  const TiltSignal before = signal;
  signal.weigh_by(VectorXd{signal.off()});
  for (Eigen::Index channel = 0; channel < 4; ++channel) {
    const auto off = signal.off().segment(4000 * channel, 4000);
    EXPECT_NEAR(off.squaredNorm() / (4000.0 - 4.0 * 6.0), 1.0, 1e-9);
    const double scatter = before.off()[4000 * channel] / off[0];
    EXPECT_NEAR(scatter, channel == 1 ? 3.0 : 0.5, 0.05 * scatter);
    EXPECT_LT(
        (signal.per_tilt() * scatter - before.per_tilt()).segment(4000 * channel, 4000).norm(),
        1e-9 * before.per_tilt().norm());
  }
}

TEST(TiltSignal, DoesNotTrustAChannelWithoutBoundThatLeavesNothing) {
  TiltSignal signal{edges_off(kSteadyChannels, 50, off_by_noise(kSteadySigma_rad, 8))};
  const VectorXd before = signal.off();
  signal.weigh_by(VectorXd::Zero(signal.edges()));
  EXPECT_NEAR(signal.off().norm(), 1e3 * before.norm(), 1e-6 * before.norm());
}

}  // namespace spindrift::testing::tilt_signal_test
