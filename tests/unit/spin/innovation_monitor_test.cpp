#include "pipelines/spin/sequential/innovation_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/unit/spin/noted.h"

namespace spindrift::innovation_monitor_test {

using testing::note;

constexpr double kGateSquares = SpinFilter::kGateSigmas * SpinFilter::kGateSigmas;

/// A revolution of six edges, some of them gated.
/// @param square Of each accepted innovation.
EdgeStatistics tally_of(double square, std::size_t gated = 0) {
  EdgeStatistics tally;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    (channel < gated ? tally.gated : tally.accepted).set(channel);
  }
  tally.squared_gates = static_cast<double>(gated) * kGateSquares;
  tally.squared_innovations =
      static_cast<double>(tally.accepted.count()) * square + tally.squared_gates;
  return tally;
}

InnovationMonitor after(int revolutions, const EdgeStatistics& tally) {
  return testing::noted<InnovationMonitor>(revolutions, tally);
}

/// Of edges with normal noise, so many times the stated variance.
InnovationMonitor after_noise(int revolutions, double times, std::mt19937_64& rng) {
  InnovationMonitor monitor;
  std::chi_squared_distribution<double> squares{6.0};
  for (int i = 0; i < revolutions; ++i) {
    monitor.note(tally_of(times * squares(rng) / 6.0));
  }
  return monitor;
}

TEST(InnovationMonitor, OfNothingSaysNothing) {
  const InnovationMonitor monitor;
  EXPECT_EQ(monitor.excess_noise(), 1.0);
  EXPECT_EQ(monitor.verdict().error_rad, 0.0);
  EXPECT_FALSE(monitor.verdict().beyond_allowance);
}

TEST(InnovationMonitor, NoiseAsStatedIsNoExcess) {
  std::mt19937_64 rng{1};
  for (int pass = 0; pass < 200; ++pass) {
    EXPECT_EQ(after_noise(100, 1.0, rng).excess_noise(), 1.0);
  }
}

TEST(InnovationMonitor, MeasuresHowManyTimesTheVarianceIsWhatItShouldBe) {
  std::mt19937_64 rng{2};
  for (const double times : {2.0, 4.0, 25.0}) {
    double mean = 0.0;
    for (int pass = 0; pass < 50; ++pass) {
      mean += after_noise(60, times, rng).excess_noise() / 50.0;
    }
    // Each of some 300 edges: 8 % of scatter.
    EXPECT_NEAR(mean, times, 0.05 * times);
  }
}

/// The mean of n squares of unit variance has the standard deviation sqrt(2 / n).
TEST(InnovationMonitor, ExcessIsWhatLiesFiveSigmasOut) {
  for (const int revolutions : {3, 10, 50}) {
    const double limit = 1.0 + 5.0 * std::sqrt(2.0 / (6.0 * revolutions));
    EXPECT_EQ(after(revolutions, tally_of(0.99 * limit)).excess_noise(), 1.0);
    EXPECT_NEAR(after(revolutions, tally_of(1.01 * limit)).excess_noise(), 1.01 * limit, 1e-9);
  }
}

TEST(InnovationMonitor, TwoRevolutionsProveNothing) {
  EXPECT_EQ(after(2, tally_of(16.0)).excess_noise(), 1.0);
  EXPECT_NEAR(after(3, tally_of(16.0)).excess_noise(), 16.0, 1e-9);
}

TEST(InnovationMonitor, RevolutionsWithoutEdgesChangeNothing) {
  InnovationMonitor monitor = after(20, tally_of(4.0));
  note(monitor, 100, EdgeStatistics{});
  EXPECT_NEAR(monitor.excess_noise(), 4.0, 1e-9);
}

TEST(InnovationMonitor, ForgetsNoiseThatIsOver) {
  InnovationMonitor monitor = after(200, tally_of(4.0));
  note(monitor, 50, tally_of(1.0));
  // Three hundred edges on, an e-th of it.
  EXPECT_NEAR(monitor.excess_noise(), 1.0 + 3.0 / std::exp(1.0), 0.03);
  note(monitor, 100, tally_of(1.0));
  EXPECT_EQ(monitor.excess_noise(), 1.0);
}

TEST(InnovationMonitor, AFewGatedEdgesAreSpuriousAndManyAreNoise) {
  EXPECT_EQ(after(100, tally_of(1.0, 1)).excess_noise(), 1.0);
  const double mean_square = (4.0 * 4.0 + 2.0 * kGateSquares) / 6.0;
  EXPECT_NEAR(after(300, tally_of(4.0, 2)).excess_noise(), mean_square, 0.01 * mean_square);
  // More of them show more, whatever the accepted ones do.
  EXPECT_GT(after(100, tally_of(1.0, 4)).excess_noise(),
            after(100, tally_of(1.0, 2)).excess_noise());
}

TEST(InnovationMonitor, AfterFadingThePastSpeaksLikeFifteenEdges) {
  InnovationMonitor monitor = after(100, tally_of(2.0));
  EXPECT_NEAR(monitor.excess_noise(), 2.0, 1e-9);
  monitor.fade();
  // Of fifteen the mean square scatters by 0.37.
  EXPECT_EQ(monitor.excess_noise(), 1.0);
  note(monitor, 5, tally_of(2.0));
  EXPECT_EQ(monitor.excess_noise(), 1.0);
  note(monitor, 10, tally_of(4.0));
  // 15 edges of 2, 30 of 2, 60 of 4.
  EXPECT_NEAR(monitor.excess_noise(), (45.0 * 2.0 + 60.0 * 4.0) / 105.0, 1e-9);
}

TEST(InnovationMonitor, OfATransientLittleIsLeftThatGoodEdgesSoonOverrule) {
  InnovationMonitor monitor = after(100, tally_of(50.0));
  monitor.discard_transient();
  EXPECT_NEAR(monitor.excess_noise(), 4.0, 1e-9);
  note(monitor, 5, tally_of(1.0));
  EXPECT_EQ(monitor.excess_noise(), 1.0);
  // One that is less than that stays what it was.
  InnovationMonitor less = after(100, tally_of(3.0));
  less.discard_transient();
  EXPECT_NEAR(less.excess_noise(), 3.0, 1e-9);
}

/// Revolutions that all together say of the azimuth of the north beam that it is off by `off_rad`,
/// so many standard deviations of what they know.
InnovationMonitor after_errors(int revolutions, double off_rad, double sigmas) {
  EdgeStatistics tally = tally_of(1.0);
  tally.errors.information(NorthAzimuth, NorthAzimuth) =
      sigmas * sigmas / (off_rad * off_rad * revolutions);
  tally.errors.score[NorthAzimuth] = off_rad * tally.errors.information(NorthAzimuth, NorthAzimuth);
  return after(revolutions, tally);
}

// Of one number, noise alone goes farther once in ten thousand times.
constexpr double kSeenFrom_sigmas = 3.8906;
constexpr double kOff_rad = 1.5 * kRadPerDeg;

TEST(InnovationMonitor, SeesAnErrorOfTheModelFromWhereNoiseDoesNotReach) {
  EXPECT_EQ(after_errors(100, kOff_rad, 0.99 * kSeenFrom_sigmas).verdict().error_rad, 0.0);
  EXPECT_GT(after_errors(100, kOff_rad, 1.01 * kSeenFrom_sigmas).verdict().error_rad, 0.0);
  const ModelTest beyond_doubt = after_errors(100, kOff_rad, 40.0).verdict();
  EXPECT_NEAR(std::sqrt(beyond_doubt.errors_rad2(NorthAzimuth, NorthAzimuth)), kOff_rad,
              0.05 * kOff_rad);
  EXPECT_TRUE(beyond_doubt.beyond_allowance);
}

TEST(InnovationMonitor, WhereTheNoiseIsMoreAnErrorMustBeMore) {
  const auto with_noise = [](double times) {
    InnovationMonitor monitor = after_errors(50, kOff_rad, 1.2 * kSeenFrom_sigmas);
    note(monitor, 300, tally_of(times));
    return monitor.verdict();
  };
  EXPECT_GT(with_noise(1.0).error_rad, 0.0);
  EXPECT_EQ(with_noise(2.0).error_rad, 0.0);
  EXPECT_NEAR(with_noise(2.0).excess_noise, 2.0, 0.05);
}

TEST(InnovationMonitor, AfterFadingErrorsAreWhatAHundredEdgesSay) {
  // A sixth of 600 edges: the root of it in standard deviations.
  for (const auto& [sigmas, seen] : {std::pair{2.4, false}, std::pair{2.5, true}}) {
    InnovationMonitor monitor = after_errors(100, kOff_rad, sigmas * kSeenFrom_sigmas);
    EXPECT_GT(monitor.verdict().error_rad, 0.0);
    monitor.fade();
    EXPECT_EQ(monitor.verdict().error_rad > 0.0, seen);
    monitor.fade();  // Of a hundred, which are left, all stay.
    EXPECT_EQ(monitor.verdict().error_rad > 0.0, seen);
  }
}

TEST(InnovationMonitor, OfATransientNoErrorIsLeft) {
  InnovationMonitor monitor = after_errors(100, kOff_rad, 100.0);
  monitor.discard_transient();
  EXPECT_EQ(monitor.verdict().error_rad, 0.0);
}

}  // namespace spindrift::innovation_monitor_test
