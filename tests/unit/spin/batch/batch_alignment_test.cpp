/// What the mission file may be off by, in the solution of `batch`.

#include <algorithm>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/spin/measurement/errors_of_alignment.h"
#include "services/base/assessment_words.h"
#include "tests/support/batch_pass.h"
#include "tests/support/misaligned.h"

namespace spindrift::testing::batch_alignment_test {

constexpr double kSigma_rad = 0.05 * kRadPerDeg;

struct BatchAlignment : ::testing::Test {
  Orbit orbit = transfer_orbit();
  std::mt19937_64 rng{46};
  SunEarthEphemeris around = seen_from(orbit);
  SpinningBody body = random_body(around, 6.0 * kRadPerDeg, rng);
  std::vector<Edge> edges = edges_of_turns(body, around, 100.0);

  BatchSolution solved(const SpinConfig& config, const std::vector<PassEdge>& pass) const {
    return solve_batch(config, orbit, pass, {.axes_icrf = {body.axis_icrf}}).value();
  }
  /// Returns the pass with the noise of an exact mission file.
  std::vector<PassEdge> pass() { return noisy_pass(body, edges, rng); }
  /// Returns the mission file that is off by these errors and states this.
  SpinConfig said(const SpinAlignmentVector& errors, const SpinAlignment& alignment) const {
    SpinConfig config = true_config(body.config, -errors);
    config.alignment = alignment;
    return config;
  }
};

TEST_F(BatchAlignment, WidensTheSigmaAndLeavesTheAxis) {
  const auto seen = pass();
  const BatchSolution exact = solved(body.config, seen);
  const BatchSolution stated = solved(said(SpinAlignmentVector::Zero(), usual_alignment()), seen);
  EXPECT_LT(angle_between_rad(exact.estimate.axis_icrf, stated.estimate.axis_icrf),
            0.02 * noise_sigma_rad(exact.estimate));
  EXPECT_NEAR(noise_sigma_rad(stated.estimate), noise_sigma_rad(exact.estimate),
              0.01 * noise_sigma_rad(exact.estimate));
  EXPECT_GT(stated.estimate.covariance_rad2.trace(), 2.0 * exact.estimate.covariance_rad2.trace());
  EXPECT_EQ(exact.estimate.alignment_rad2, Eigen::Matrix2d::Zero());
  EXPECT_NEAR(stated.choice.shifts.front().shift_icrf.squaredNorm(),
              stated.estimate.alignment_rad2.trace(),
              1e-9 * stated.estimate.alignment_rad2.trace());
  EXPECT_EQ(stated.estimate.assessment.quality, Quality::Ok)
      << sentence_of(stated.estimate.assessment);
}

TEST_F(BatchAlignment, ShiftsTheAxisByItsSensitivity) {
  const auto seen = pass();
  const SpinAlignment alignment = independent_alignment(kSigma_rad, 3.0);
  const BatchSolution as_said = solved(said(SpinAlignmentVector::Zero(), alignment), seen);
  for (int error = 0; error < TimeTagError; ++error) {
    SCOPED_TRACE(kSpinAlignmentKeys.at(static_cast<std::size_t>(error)));
    const double sigma = std::sqrt(alignment(error, error));
    // A file that is less by its error than this one has this one as its truth.
    const BatchSolution corrected =
        solved(said(-sigma * SpinAlignmentVector::Unit(error), alignment), seen);
    // The weights of edges change with their residuals.
    const Eigen::Vector3d moved = corrected.estimate.axis_icrf - as_said.estimate.axis_icrf;
    const Eigen::Vector3d expected = as_said.choice.shifts.front().shift_icrf.col(error);
    EXPECT_LT((moved - expected).norm(), 0.05 * expected.norm() + 1e-6);
  }
}

TEST_F(BatchAlignment, AnErrorWithinItIsOkAndOneBeyondNamesTheKey) {
  const auto seen = pass();
  const SpinAlignmentVector off = SpinAlignmentVector::Unit(NorthAzimuthError);
  const BatchSolution within = solved(said(2.0 * kSigma_rad * off, usual_alignment()), seen);
  EXPECT_EQ(within.estimate.assessment.quality, Quality::Ok)
      << sentence_of(within.estimate.assessment);
  const BatchSolution beyond = solved(said(20.0 * kSigma_rad * off, usual_alignment()), seen);
  EXPECT_EQ(beyond.estimate.assessment.quality, Quality::Doubtful);
  EXPECT_THAT(sentence_of(beyond.estimate.assessment),
              ::testing::HasSubstr("spin.ir.north.azimuth_deg"));
}

TEST_F(BatchAlignment, ABiasBeyondWhatTheFileStatesOfItIsDoubted) {
  const double dihedral_rad = 8.0 * kSigma_rad;
  auto seen = pass();
  for (PassEdge& edge : seen) {
    if (!sees_the_sun(edge.pulse.channel)) {
      edge.pulse.t += std::chrono::nanoseconds{std::llround(1e9 * dihedral_rad / body.rate_rad_s)};
    }
  }
  SpinConfig config = said(SpinAlignmentVector::Zero(), usual_alignment());
  config.batch.biases = BiasSet{}.set(DihedralBias);
  const BatchSolution solution = solved(config, seen);
  const auto found = std::find_if(solution.biases.begin(), solution.biases.end(),
                                  [](const auto& bias) { return bias.bias == DihedralBias; });
  ASSERT_NE(found, solution.biases.end());
  EXPECT_TRUE(found->estimated);
  EXPECT_NEAR(found->value, dihedral_rad, 4.0 * found->sigma);
  EXPECT_DOUBLE_EQ(found->stated_sigma, kSigma_rad / std::sqrt(2.0));
  EXPECT_THAT(sentence_of(solution.estimate.assessment),
              ::testing::HasSubstr("more than 4 times its prior"));
}

TEST_F(BatchAlignment, ABiasToEstimateHasItsPriorFromIt) {
  SpinConfig config = said(SpinAlignmentVector::Zero(), usual_alignment());
  config.batch.biases = BiasSet{}.set(NorthMountAngleBias).set(DihedralBias).set(NorthChordBias);
  config.batch.biases->set(SunAngleBias);
  const double sun_angle_rad = 1.1;
  const BiasPriors priors{config, sun_angle_rad};
  const SensorBiases sigmas = priors.of_estimated();
  EXPECT_DOUBLE_EQ(sigmas[NorthMountAngleBias], kSigma_rad);
  EXPECT_DOUBLE_EQ(sigmas[DihedralBias], kSigma_rad / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(sigmas[NorthChordBias], 2.0 * kSigma_rad);
  const SpinAlignmentVector larger = sun_angle_per_error(config.sun_sensor, sun_angle_rad);
  EXPECT_DOUBLE_EQ(sigmas[SunAngleBias], kSigma_rad * larger.norm());
  const SpinAlignment left = priors.alignment_beside(*config.batch.biases);
  // Of the slits only what leaves the sun angle alone is left.
  EXPECT_NEAR(larger.dot(left * larger), 0.0, 1e-20);
  EXPECT_NEAR((left.topLeftCorner<2, 2>().trace()), kSigma_rad * kSigma_rad, 1e-15);
  EXPECT_NEAR(larger.dot(priors.errors_of(SunAngleBias)), 1.0, 1e-12);
  EXPECT_NEAR(left(NorthMountAngleError, NorthMountAngleError), 0.0, 1e-20);
  // The difference of the azimuths is left.
  EXPECT_NEAR(left(NorthAzimuthError, NorthAzimuthError), 0.5 * kSigma_rad * kSigma_rad, 1e-15);
  EXPECT_NEAR(left(NorthAzimuthError, SouthAzimuthError), -0.5 * kSigma_rad * kSigma_rad, 1e-15);
  EXPECT_EQ(left(SouthMountAngleError, SouthMountAngleError), kSigma_rad * kSigma_rad);
  config.alignment.setZero();
  EXPECT_EQ(BiasPriors(config, sun_angle_rad).of_estimated(), range_sigmas());
}

TEST_F(BatchAlignment, NormalEquationsShowAnErrorOfTheFile) {
  const auto seen = pass();
  for (const bool estimated : {false, true}) {
    SCOPED_TRACE(estimated);
    const double off_rad = 2.0 * kSigma_rad;
    SpinConfig config = said(off_rad * SpinAlignmentVector::Unit(NorthAzimuthError) +
                                 off_rad * SpinAlignmentVector::Unit(SouthAzimuthError),
                             usual_alignment());
    config.batch.biases = BiasSet{}.set(DihedralBias, estimated);
    const NormalEquations equations = solved(config, seen).equations;
    ASSERT_EQ(equations.names.size(), 8U);
    Eigen::VectorXd off_deg = Eigen::VectorXd::Zero(8);
    for (Eigen::Index i = 0; i < 8; ++i) {
      const std::string& name = equations.names[static_cast<std::size_t>(i)];
      off_deg[i] = name.ends_with("azimuth_deg") ? off_rad / kRadPerDeg : 0.0;
      if (name == "spin.ir.north.azimuth_deg") {
        EXPECT_NEAR(equations.b0[i], config.north->azimuth_rad / kRadPerDeg, 1e-12);
      }
    }
    const Eigen::VectorXd expected = equations.n * off_deg;
    EXPECT_GT(off_deg.dot(expected), 100.0);
    for (Eigen::Index i = 0; i < 8; ++i) {
      SCOPED_TRACE(equations.names[static_cast<std::size_t>(i)]);
      // The score has the covariance n; a few percent are of the curvature.
      EXPECT_NEAR(equations.g[i], expected[i],
                  4.0 * std::sqrt(equations.n(i, i)) + 0.03 * std::abs(expected[i]));
    }
    EXPECT_LT((equations.n - equations.n.transpose()).norm(), 1e-9 * equations.n.norm());
  }
}

}  // namespace spindrift::testing::batch_alignment_test
