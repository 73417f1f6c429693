/// Mission files that are off within what they state, over many passes: the normalised squared
/// errors of all estimators are as they claim, and as many rows are OK as with an exact file.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>

#include "pipelines/statistics/distributions.h"
#include "services/base/assessment_words.h"
#include "tests/support/misaligned_spin_passes.h"

namespace spindrift::testing::spin_alignment_many_test {

constexpr double kPass_s = 300.0;
constexpr std::uint64_t kPasses = 200;
constexpr std::uint64_t kSeed = 462;

/// Sums passes that are of the same bodies with the same noise, whatever the errors.
AlignmentSums sums_of(const SpinAlignment& states, const SpinAlignment& errors) {
  AlignmentSums sums;
  for (std::uint64_t i = 0; i < kPasses; ++i) {
    MisalignedPasses passes{kSeed + i, kPass_s};
    sums.add(passes.drawn(states, errors), passes.orbit());
  }
  return sums;
}

TEST(SpinAlignmentMany, SigmasAreTotal) {
  const AlignmentSums stated = sums_of(usual_alignment(), usual_alignment());
  stated.record("stated");
  for (const SpinEstimator estimator :
       {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
    SCOPED_TRACE(name_of(estimator));
    const auto i = static_cast<std::size_t>(estimator);
    const double freedom = 2.0 * stated.answers.at(i);
    EXPECT_GT(stated.squares.at(i), chi_square_beyond(0.975, freedom));
    EXPECT_LT(stated.squares.at(i), chi_square_beyond(0.025, freedom));
  }
  EXPECT_LE(stated.beyond_four, stated.ok / 1000);
  EXPECT_LT(stated.worst, 5.0);

  const AlignmentSums exact = sums_of(SpinAlignment::Zero(), SpinAlignment::Zero());
  exact.record("exact");
  EXPECT_GE(stated.ok / static_cast<double>(stated.rows),
            exact.ok / static_cast<double>(exact.rows));
}

/// Returns the solution by `batch` of a body whose mission file is off by an error, in rad or km.
BatchSolution solution_of(MisalignedPasses& passes, SpinningBody body, SpinAlignmentError error,
                          double off) {
  body.config.alignment = usual_alignment();
  const MisalignedSpinPass pass = passes.of(body, off * SpinAlignmentVector::Unit(error));
  const SpinOutput output = run(SpinPass{pass.said, passes.orbit()}, pass.pulses);
  return solved(pass.said, passes.orbit(), output).value();
}

TEST(SpinAlignmentMany, ABeamOffByADegreeIsDoubtedAndNamed) {
  MisalignedPasses passes{463, kPass_s};
  int named = 0;
  for (int i = 0; i < 20; ++i) {
    const double off_rad = (i % 2 == 0 ? 1.0 : -1.0) * kRadPerDeg;
    const Assessment said =
        solution_of(passes, passes.body(), NorthAzimuthError, off_rad).estimate.assessment;
    EXPECT_EQ(said.quality, Quality::Doubtful) << sentence_of(said);
    named += sentence_of(said).find("spin.ir.north.azimuth_deg") != std::string::npos ? 1 : 0;
  }
  RecordProperty("named", named);
  EXPECT_GE(named, 18);
}

/// Returns the chi-square of an error in deg that is left when the errors that the mission file
/// states have explained what they can.
double left_of(const NormalEquations& equations, Eigen::Index error, double off_deg) {
  Eigen::VectorXd sigmas = Eigen::VectorXd::Constant(8, 0.05);
  sigmas[6] = 3.0;
  sigmas[7] = 0.0;
  const Eigen::MatrixXd stated = sigmas.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd left =
      (Eigen::MatrixXd::Identity(8, 8) + equations.n * stated).lu().solve(equations.n);
  return left(error, error) * off_deg * off_deg;
}

TEST(SpinAlignmentMany, ASunSensorOffByTwoDegreesIsDoubtedWhereTheGeometryShowsIt) {
  MisalignedPasses passes{464, kPass_s};
  constexpr Eigen::Index kSeparation = 1;
  int shown = 0;
  for (int i = 0; i < 20; ++i) {
    const SpinningBody body = passes.body();
    const BatchSolution exact = solution_of(passes, body, SlitSeparationError, 0.0);
    const BatchSolution solution = solution_of(passes, body, SlitSeparationError, 2.0 * kRadPerDeg);
    // With Sun and Earth both across the axis it moves the axis alone.
    if (left_of(exact.equations, kSeparation, 2.0) > 100.0) {
      ++shown;
      const Assessment& said = solution.estimate.assessment;
      EXPECT_EQ(said.quality, Quality::Doubtful) << sentence_of(said);
      EXPECT_TRUE(has(said, ReasonCode::ModelOff)) << sentence_of(said);
    }
  }
  RecordProperty("shown", shown);
  EXPECT_GE(shown, 4);
}

}  // namespace spindrift::testing::spin_alignment_many_test
