#include "pipelines/spin/batch/pass_information.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "pipelines/statistics/distributions.h"
#include "tests/support/batch_pass.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::pass_information_test {

using Motion = Eigen::Matrix<double, kMotionUnknowns, 1>;

/// Returns the state with changed motion, in the unknowns of pass_model.h: rate and drift are given
/// as the angle at the end of the pass, linear and quadratic in the time from its middle.
SpinState changed(const SpinState& state, const PassModel& model, const Motion& change) {
  SpinState other = state;
  const Eigen::Vector3d turn_rad = change.head<3>();
  other.q_icrf_spin = state.q_icrf_spin * Eigen::Quaterniond{Eigen::AngleAxisd{
                                              turn_rad.norm(), turn_rad.stableNormalized()}};
  other.rate_rad_s += change[3] / model.half_s();
  other.drift_rad_s2 += 2.0 * change[4] / std::pow(model.half_s(), 2);
  return other;
}

/// Holds edges without noise and the state that they come from.
class ExactPassInformation : public ::testing::Test, protected ExactPass {
 protected:
  PassInformation of(const Motion& change) const {
    return information_of(model, edges, changed(truth, model, change));
  }
};

/// Returns the information on the motion alone.
Eigen::Matrix<double, kMotionUnknowns, kMotionUnknowns> of_motion(const PassInformation& found) {
  return found.information.topLeftCorner<kMotionUnknowns, kMotionUnknowns>();
}

/// Returns the mean over unit normal noise, integrated by rectangles.
double mean_over_noise(const std::function<double(double)>& of) {
  constexpr double kStep = 1e-3;
  double sum = 0.0;
  for (double x = -kOutlierSigmas; x <= kOutlierSigmas; x += kStep) {
    sum += of(x) * std::exp(-0.5 * x * x) * kStep;
  }
  return sum / std::sqrt(2.0 * std::numbers::pi);
}

/// Tukey's function and its derivative (Huber and Ronchetti, Robust Statistics, 4.8).
double tukey(double x) { return x * std::pow(1.0 - std::pow(x / kOutlierSigmas, 2), 2); }
double tukey_slope(double x) {
  const double part = std::pow(x / kOutlierSigmas, 2);
  return (1.0 - part) * (1.0 - 5.0 * part);
}

TEST(PassInformation, ItsConstantsAreThoseOfTheBiweight) {
  const double slope = mean_over_noise(tukey_slope);
  const double square = mean_over_noise([](double x) { return tukey(x) * tukey(x); });
  EXPECT_NEAR(kMeanSlope, slope, 1e-5);
  EXPECT_NEAR(kEfficiency, slope * slope / square, 1e-5);
}

TEST_F(ExactPassInformation, OfExactEdgesAtTheTruthIsWithoutMisfit) {
  const PassInformation found = of(Motion::Zero());
  EXPECT_EQ(found.edges, static_cast<std::int64_t>(edges.size()));
  EXPECT_EQ(found.outliers, 0);
  EXPECT_EQ(found.outlier_share(), 0.0);
  // Sun and Earth are held constant for ten seconds, which costs 1/100 of an edge's noise.
  EXPECT_LT(found.squares, 1e-4 * static_cast<double>(found.edges));
}

/// At a small distance x from the truth the squares are x.information x, however the slopes are
/// computed.
TEST_F(ExactPassInformation, IsHowTheSquaresGrowBesideTheTruth) {
  const PassInformation at_truth = of(Motion::Zero());
  const auto information = of_motion(at_truth);
  std::mt19937_64 rng{5};
  std::normal_distribution<double> normal;
  for (int i = 0; i < 30; ++i) {
    // Change each unknown alone, then all together.
    Motion change = Motion::Zero();
    if (i < kMotionUnknowns) {
      change[i] = 1.0;
    } else {
      std::ranges::generate(change, [&] { return normal(rng); });
    }
    // Scale the change to one sigma an edge.
    change *= std::sqrt(static_cast<double>(at_truth.edges) / change.dot(information * change));
    // The mean over both signs cancels the residuals at the truth.
    const double squares = 0.5 * (of(change).squares + of(-change).squares);
    EXPECT_NEAR(squares / change.dot(information * change), 1.0, 0.01) << i;
  }
}

TEST_F(ExactPassInformation, ItsStepLeadsBackToTheTruth) {
  const auto step_from = [&](const Motion& change) {
    const PassInformation there = of(change);
    const auto information = of_motion(there);
    const Motion score = there.score.head<kMotionUnknowns>();
    return Motion{-information.ldlt().solve(score)};
  };
  const Motion here = step_from(Motion::Zero());
  for (int i = 0; i < kMotionUnknowns; ++i) {
    const Motion change = 1e-4 * Motion::Unit(i);
    // Near zero the slope of the biweight is 1, whereas the step uses its mean over noise.
    const Motion step = (step_from(change) - here) * kMeanSlope;
    EXPECT_LT((step + change).norm(), 0.05 * change.norm()) << i;
  }
}

PassInformation at_the_truth(const BatchScene& scene, const std::vector<PassEdge>& edges) {
  const PassModel model = scene.model(edges);
  return information_of(model, edges, true_state(scene.body, model));
}

TEST(PassInformation, OfNoiseAsStatedHasASquareForEachEdge) {
  BatchScene scene{62};
  const auto edges = scene.pass(100.0);
  const PassInformation found = at_the_truth(scene, edges);
  const auto count = static_cast<double>(edges.size());
  EXPECT_EQ(found.outliers, 0);
  EXPECT_NEAR(found.squares, count, 4.0 * std::sqrt(2.0 * count));
  EXPECT_EQ(found.excess_noise(kMotionUnknowns), 1.0);
  // The covariance of the motion's score is the information over the efficiency.
  const auto information = of_motion(found);
  const Motion score = found.score.head<kMotionUnknowns>();
  const double chi_square = kEfficiency * score.dot(information.ldlt().solve(score));
  EXPECT_LT(chi_square, chi_square_beyond(1e-4, kMotionUnknowns));
}

TEST(PassInformation, NoiseThatIsMoreThanStatedShowsInItsSquares) {
  BatchScene scene{63};
  auto noisier = scene.body;
  noisier.config.noise.sun_s *= 2.0;
  noisier.config.noise.infrared_s *= 2.0;
  const auto edges = scene.pass_of(noisier, 100.0);
  const PassInformation found = at_the_truth(scene, edges);
  EXPECT_NEAR(found.excess_noise(kMotionUnknowns), 4.0, 0.7);
}

TEST_F(ExactPassInformation, AnEdgeBeyondEightSigmasIsAnOutlierAndSaysNothing) {
  const auto moved = [&](double sigmas) {
    std::vector<PassEdge> some = edges;
    for (std::size_t i = 0; i < some.size(); i += 10) {
      const double sigma_s = edge_sigma_s(scene.body.config.noise, some[i].pulse.channel);
      some[i].pulse.t = shifted(some[i].pulse.t, sigmas * sigma_s);
    }
    return information_of(model, some, truth);
  };
  const auto tenth = static_cast<std::int64_t>((edges.size() + 9) / 10);
  EXPECT_EQ(moved(7.9).outliers, 0);
  EXPECT_NEAR(moved(7.9).squares, static_cast<double>(tenth) * 7.9 * 7.9, 15.0);
  const PassInformation beyond = moved(8.1);
  EXPECT_EQ(beyond.outliers, tenth);
  EXPECT_EQ(beyond.edges + beyond.outliers, static_cast<std::int64_t>(edges.size()));
  EXPECT_NEAR(beyond.outlier_share(), 0.1, 0.002);
  EXPECT_NEAR(beyond.misfit(), 64.0 * static_cast<double>(tenth), 1.0);
  // Outliers must have no effect, however far off they are.
  std::vector<PassEdge> others = edges;
  std::size_t i = 0;
  std::erase_if(others, [&](const PassEdge&) { return i++ % 10 == 0; });
  const PassInformation without = information_of(model, others, truth);
  EXPECT_LT((beyond.information - without.information).norm(), 1e-12 * without.information.norm());
  EXPECT_LT((moved(20.0).score - without.score).norm(), 1e-9 * (1.0 + without.score.norm()));
}

TEST_F(ExactPassInformation, WithoutALimitEachEdgeSpeaks) {
  const SpinState off = changed(truth, model, 0.05 * Motion::Unit(2));
  EXPECT_EQ(information_of(model, edges, off).edges, 0);
  const PassInformation found =
      information_of(model, edges, off, std::numeric_limits<double>::infinity());
  EXPECT_EQ(found.outliers, 0);
  EXPECT_EQ(found.edges, static_cast<std::int64_t>(edges.size()));
}

TEST_F(ExactPassInformation, OfSpansIsThatOfThePassInOrder) {
  const PassInformation whole = information_of(model, edges, truth);
  for (const std::size_t count : {1U, 7U, 50U}) {
    const auto spans = information_by_span(model, edges, truth, count);
    ASSERT_EQ(spans.size(), count);
    PassInformation sum;
    std::size_t next = 0;
    for (const SpanInformation& span : spans) {
      EXPECT_EQ(span.first_edge, next);
      EXPECT_EQ(span.begin, edges[next].pulse.t);
      const auto count_here = static_cast<std::size_t>(span.of.edges);
      EXPECT_NEAR(static_cast<double>(count_here),
                  static_cast<double>(edges.size()) / static_cast<double>(count), 1.0);
      next += count_here;
      sum += span.of;
    }
    EXPECT_EQ(next, edges.size());
    EXPECT_LT((sum.information - whole.information).norm(), 1e-12 * whole.information.norm());
    EXPECT_LT((sum.score - whole.score).norm(), 1e-9 * (1.0 + whole.score.norm()));
    EXPECT_NEAR(sum.squares, whole.squares, 1e-9);
    EXPECT_EQ(sum.edges, whole.edges);
  }
}

TEST_F(ExactPassInformation, OfFewEdgesHasASpanForEach) {
  const std::span<const PassEdge> few{edges.data(), 3};
  const auto spans = information_by_span(model, few, truth, 10);
  ASSERT_EQ(spans.size(), 3U);
  EXPECT_EQ(spans[2].first_edge, 2U);
  EXPECT_TRUE(information_by_span(model, {}, truth, 10).empty());
}

/// A chi-square is excessive if noise exceeds it once in a million times.
TEST(PassInformation, ExcessIsWhatNoiseDoesOnceInAMillionTimes) {
  for (const std::int64_t freedom : {10, 100, 1000, 100'000}) {
    PassInformation found;
    found.edges = freedom + 7;
    const double limit = chi_square_beyond(1e-6, static_cast<double>(freedom));
    found.squares = 0.95 * limit;
    EXPECT_EQ(found.excess_noise(7), 1.0) << freedom;
    found.squares = 1.05 * limit;
    EXPECT_DOUBLE_EQ(found.excess_noise(7), found.squares / static_cast<double>(freedom));
  }
}

TEST(PassInformation, EdgesAsManyAsUnknownsSayNothingOfTheNoise) {
  PassInformation found;
  found.edges = 5;
  found.squares = 1e6;
  EXPECT_EQ(found.excess_noise(5), 1.0);
  EXPECT_EQ(found.excess_noise(6), 1.0);
}

}  // namespace spindrift::testing::pass_information_test
