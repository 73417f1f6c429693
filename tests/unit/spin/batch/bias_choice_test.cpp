/// The bias chosen by the residuals, compared with closed forms of the quadratic likelihood.

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "pipelines/spin/batch/bias_selection.h"
#include "tests/support/matchers.h"

namespace spindrift::bias_choice_test {

constexpr BiasSet kNone;

/// Adds edges that ask for a bias with a likelihood gain of `gain`. They determine the bias twenty
/// times as well as its prior and do not mix it with the motion.
void ask_for(SensorBias bias, double gain, PassInformation& pass) {
  const double prior = range_sigmas()[bias];
  const int row = kMotionUnknowns + bias;
  pass.information(row, row) = 399.0 / (prior * prior);
  pass.score[row] = std::sqrt(gain * 400.0) / prior;
}

PassInformation known_motion() {
  PassInformation pass;
  pass.information.diagonal().head<kMotionUnknowns>().setConstant(1e8);
  pass.edges = 1000;
  return pass;
}

/// Returns the information of edges with random slopes, which mix all unknowns. The state is the
/// optimum without `bias`, so that no other unknown has a score.
PassInformation mixed(SensorBias bias, double score, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  PassInformation pass;
  for (int edge = 0; edge < 100; ++edge) {
    Eigen::Matrix<double, kBatchUnknowns, 1> slopes;
    for (int i = 0; i < kBatchUnknowns; ++i) {
      const double unit = i < kMotionUnknowns ? 0.01 : range_sigmas()[i - kMotionUnknowns];
      slopes[i] = normal(rng) / unit;
    }
    pass.information += slopes * slopes.transpose();
  }
  pass.score[kMotionUnknowns + bias] = score / range_sigmas()[bias];
  pass.edges = 100;
  return pass;
}

TEST(BiasChoice, ResidualsThatNoiseExplainsAskForNone) {
  PassInformation pass = known_motion();
  EXPECT_FALSE(most_significant_bias(pass, kNone));
  // The largest of eight chi-squares of one degree exceeds 19.2 once in 10^4 passes.
  ask_for(NorthChordBias, 19.1, pass);
  EXPECT_FALSE(most_significant_bias(pass, kNone));
}

TEST(BiasChoice, TheOneThatExplainsMostIsWantedUnlessItIsEstimatedAlready) {
  PassInformation pass = known_motion();
  ask_for(NorthChordBias, 30.0, pass);
  ask_for(Co2HeightBias, 40.0, pass);
  ask_for(SunAngleBias, 20.0, pass);
  const auto wanted = most_significant_bias(pass, kNone).value();
  EXPECT_EQ(wanted.bias, Co2HeightBias);
  EXPECT_NEAR(wanted.gain, 40.0, 1e-9);
  // What is estimated already is not wanted.
  const auto next = most_significant_bias(pass, BiasSet{}.set(Co2HeightBias)).value();
  EXPECT_EQ(next.bias, NorthChordBias);
  EXPECT_FALSE(most_significant_bias(
      pass, BiasSet{}.set(Co2HeightBias).set(NorthChordBias).set(SunAngleBias)));
  EXPECT_FALSE(most_significant_bias(pass, BiasSet{}.set()));
}

TEST(BiasChoice, NoiseBeyondWhatIsStatedMakesItLessSure) {
  PassInformation pass = known_motion();
  ask_for(NorthChordBias, 50.0, pass);
  pass.squares = 4.0 * static_cast<double>(pass.edges - kMotionUnknowns);
  EXPECT_FALSE(most_significant_bias(pass, kNone));
  ask_for(NorthChordBias, 100.0, pass);
  const auto wanted = most_significant_bias(pass, kNone).value();
  EXPECT_NEAR(wanted.gain, 25.0, 1e-9);
}

TEST(BiasChoice, TheGainIsWhatTheSquaresFallByAtTheMinimum) {
  std::mt19937_64 rng{1821};
  for (int trial = 0; trial < 50; ++trial) {
    const PassInformation pass = mixed(DihedralBias, 500.0, rng);
    const BiasSet estimated = BiasSet{}.set(SunAngleBias).set(SouthChordBias);
    const auto wanted = most_significant_bias(pass, estimated).value();
    ASSERT_EQ(wanted.bias, DihedralBias);
    // Solves for motion and the three biases by another decomposition. The prior of the motion is
    // one radian.
    const std::array<int, 8> unknowns{0,
                                      1,
                                      2,
                                      3,
                                      4,
                                      kMotionUnknowns + SunAngleBias,
                                      kMotionUnknowns + SouthChordBias,
                                      kMotionUnknowns + DihedralBias};
    Eigen::Matrix<double, 8, 8> information = pass.information(unknowns, unknowns);
    information.diagonal().head<5>().array() += 1.0;
    for (int i = 5; i < 8; ++i) {
      const double prior = range_sigmas()[unknowns.at(static_cast<std::size_t>(i)) - 5];
      information(i, i) += 1.0 / (prior * prior);
    }
    const Eigen::Matrix<double, 8, 1> score = pass.score(unknowns);
    const Eigen::Matrix<double, 8, 1> best = information.fullPivLu().solve(-score);
    const double falls_by = -(best.dot(information * best) + 2.0 * score.dot(best));
    EXPECT_NEAR(wanted.gain / falls_by, 1.0, 1e-9);
  }
}

TEST(BiasChoice, TwoThatExplainTheSameLeaveHalfTheirDistanceSquaredOpen) {
  // Either chord explains the residuals, since each moves the phase; they tilt the axis
  // differently.
  PassInformation pass = known_motion();
  ask_for(NorthChordBias, 1000.0, pass);
  ask_for(SouthChordBias, 1000.0, pass);
  const double mixing = 1e5;
  const int north = kMotionUnknowns + NorthChordBias;
  const int south = kMotionUnknowns + SouthChordBias;
  pass.information(0, north) = pass.information(north, 0) = mixing;
  pass.information(0, south) = pass.information(south, 0) = -mixing;
  const Eigen::Matrix2d open_rad2 = other_biases_rad2(pass, kNone, NorthChordBias);
  // Each bias is -score / left, where `left` is its remaining information, and tilts the axis by
  // -mixing / motion of that.
  const double motion = 1e8 + 1.0;
  const double left =
      400.0 / std::pow(range_sigmas()[NorthChordBias], 2) - mixing * mixing / motion;
  const double tilt_rad = mixing / motion * pass.score[north] / left;
  EXPECT_NEAR(open_rad2(0, 0) / (0.5 * 4.0 * tilt_rad * tilt_rad), 1.0, 1e-9);
  EXPECT_EQ(open_rad2(0, 1), 0.0);
  EXPECT_EQ(open_rad2(1, 1), 0.0);
}

TEST(BiasChoice, OneThatAloneExplainsThemLeavesNothingOpen) {
  PassInformation pass = known_motion();
  ask_for(NorthChordBias, 1000.0, pass);
  ask_for(SouthChordBias, 10.0, pass);
  pass.information(0, kMotionUnknowns + NorthChordBias) = 1e5;
  pass.information(kMotionUnknowns + NorthChordBias, 0) = 1e5;
  EXPECT_LT(other_biases_rad2(pass, kNone, NorthChordBias).norm(), 1e-100);
}

}  // namespace spindrift::bias_choice_test
