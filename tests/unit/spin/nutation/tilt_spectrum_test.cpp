#include <cmath>
#include <complex>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/nutation/tilt_signal.h"
#include "tests/support/matchers.h"
#include "tests/unit/spin/nutation/edges_off.h"

namespace spindrift::testing::tilt_spectrum_test {

constexpr int kTurns = 200;

Off circle(double size_rad, double per_turn) { return off_by_circle(size_rad, per_turn, 0.4); }

TiltSignal signal_of(const Off& off_rad, int turns = kTurns) {
  return TiltSignal{edges_off(kSteadyChannels, turns, off_rad)};
}

// Frequency resolution of the pass.
constexpr double kResolved_per_turn = 1.0 / kTurns;

bool is_seen(const TiltSignal& signal, double per_turn) {
  return std::abs(per_turn - std::round(per_turn)) > unseen_per_turn(signal);
}

/// Returns |D| by its definition, edge by edge.
double power(const TiltSignal& signal, double per_turn) {
  std::complex<double> sum;
  for (Eigen::Index i = 0; i < signal.edges(); ++i) {
    sum += signal.off()[i] * signal.per_tilt()[i] *
           std::polar(1.0, -kTurn_rad * per_turn * signal.turns()[i]);
  }
  return std::norm(sum);
}

/// Returns the peak on a grid ten times finer than the resolution.
double strongest_by_definition(const TiltSignal& signal, int turns) {
  double best_per_turn = 0.0;
  double best_power = 0.0;
  const double step = 0.1 / turns;
  for (double per_turn = step; per_turn <= kFastestPerTurn; per_turn += step) {
    const double here = is_seen(signal, per_turn) ? power(signal, per_turn) : 0.0;
    if (here > best_power) {
      best_power = here;
      best_per_turn = per_turn;
    }
  }
  return best_per_turn;
}

TEST(TiltSpectrum, IsStrongestWhereTheTiltGoesRound) {
  for (const double per_turn : {0.07, 0.37, 0.81, 1.24, 1.61, 1.93}) {
    for (const double noise_rad : {0.0, 3.0 * kSteadySigma_rad}) {
      const TiltSignal signal =
          signal_of(sum_of(circle(2.0 * kSteadySigma_rad, per_turn), off_by_noise(noise_rad, 1)));
      EXPECT_NEAR(strongest_per_turn(signal), per_turn, 0.25 * kResolved_per_turn + 1e-12)
          << noise_rad;
    }
  }
}

TEST(TiltSpectrum, DoesNotDependOnTheUnitOfTheResiduals) {
  const TiltSignal one = signal_of(sum_of(circle(1e-3, 1.37), off_by_noise(1e-3, 1)));
  const TiltSignal other = signal_of(sum_of(circle(1e-7, 1.37), off_by_noise(1e-7, 1)));
  EXPECT_EQ(strongest_per_turn(one), strongest_per_turn(other));
}

TEST(TiltSpectrum, OfTwoTiltsTheStrongerWins) {
  const auto strongest = [](double slow_rad, double fast_rad) {
    return strongest_per_turn(signal_of(sum_of(circle(slow_rad, 0.37), circle(fast_rad, 1.84))));
  };
  EXPECT_NEAR(strongest(1.1e-3, 1e-3), 0.37, 0.25 * kResolved_per_turn);
  EXPECT_NEAR(strongest(1e-3, 1.1e-3), 1.84, 0.25 * kResolved_per_turn);
}

/// Noise has peaks everywhere. A quarter of the resolution beside a peak the power is (sin(pi / 4)
/// / (pi / 4))^2 = 0.81 of it.
TEST(TiltSpectrum, ItsPeakIsThatOfTheDefinition) {
  constexpr int kFew = 60;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const TiltSignal signal = signal_of(off_by_noise(kSteadySigma_rad, seed), kFew);
    const double found = strongest_per_turn(signal);
    EXPECT_TRUE(is_seen(signal, found));
    EXPECT_GT(found, 0.0);
    EXPECT_LE(found, kFastestPerTurn);
    EXPECT_GT(power(signal, found), 0.75 * power(signal, strongest_by_definition(signal, kFew)))
        << seed;
  }
}

/// Frequencies closer to a whole number are mostly removed with the slow changes.
TEST(TiltSpectrum, UnseenIsWhatSlowChangesTakeAlong) {
  const auto share_left = [](double whole, double beside) {
    const TiltSignal still = signal_of(circle(0.0, 0.0));
    const Eigen::MatrixX2d before = still.pattern(whole + beside * unseen_per_turn(still));
    Eigen::MatrixXd left = before;
    still.take_out_slow_changes(left);
    return left.squaredNorm() / before.squaredNorm();
  };
  for (const double whole : {0.0, 1.0, 2.0}) {
    EXPECT_LT(share_left(whole, 0.0), 1e-12);
    EXPECT_LT(share_left(whole, 0.1), 0.01);
    EXPECT_GT(share_left(whole, -1.0), 0.9);
    EXPECT_GT(share_left(whole, 1.0), 0.9);
  }
}

TEST(TiltSpectrum, NamesNoTiltThatGoesRoundAWholeNumberOfTimes) {
  for (const double per_turn : {0.006, 0.995, 1.004, 1.996}) {
    const TiltSignal signal = signal_of(sum_of(circle(0.1, per_turn), off_by_noise(1e-6, 1)));
    EXPECT_FALSE(is_seen(signal, per_turn));
    EXPECT_TRUE(is_seen(signal, strongest_per_turn(signal)));
  }
}

}  // namespace spindrift::testing::tilt_spectrum_test
