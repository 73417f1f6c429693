#include "pipelines/three_axis/alignment_evidence.h"

#include <Eigen/Dense>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::alignment_evidence_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSun_rad = 0.2 * kRadPerDeg;
constexpr double kField_rad = 0.3 * kRadPerDeg;
constexpr double kNoise_rad = 0.5 * kRadPerDeg;

FilterAlignment stated() {
  FilterAlignment prior = FilterAlignment::Zero();
  prior.diagonal().segment<3>(SunSensorError).setConstant(kSun_rad * kSun_rad);
  prior.diagonal().segment<3>(MagnetometerError).setConstant(kField_rad * kField_rad);
  return prior;
}

/// Returns the derivative of what a sun sensor measures against a magnetometer.
TurnPerError difference() {
  TurnPerError per_error = TurnPerError::Zero();
  per_error.middleCols<3>(SunSensorError) = -Matrix3d::Identity();
  per_error.middleCols<3>(MagnetometerError) = Matrix3d::Identity();
  return per_error;
}

/// Adds innovations of sensors whose mountings differ by `off_rad`.
/// @return The mean of the squares per degree of freedom.
double add(AlignmentEvidence& evidence, const Vector3d& off_rad, int count, std::mt19937_64& rng) {
  double squares = 0.0;
  for (int i = 0; i < count; ++i) {
    squares += evidence.add<3>(off_rad + normal_vector(rng, kNoise_rad), difference(),
                               kNoise_rad * kNoise_rad * Matrix3d::Identity());
  }
  return squares / (3.0 * count);
}

TEST(AlignmentEvidence, IsTheInformationOfTheInnovations) {
  std::mt19937_64 rng{4610};
  AlignmentEvidence evidence{stated()};
  add(evidence, {1e-3, 0.0, -2e-3}, 50, rng);
  const TurnPerError per_error = difference();
  const double weight = 50.0 / (kNoise_rad * kNoise_rad);
  EXPECT_LT((evidence.information() - weight * per_error.transpose() * per_error).norm(),
            1e-9 * weight);
  const Vector3d score = evidence.score().segment<3>(MagnetometerError);
  EXPECT_LT((score / weight - Vector3d{1e-3, 0.0, -2e-3}).norm(),
            4.0 * kNoise_rad / std::sqrt(50.0));
  EXPECT_EQ(evidence.score().segment<3>(SunSensorError), -score);
  EXPECT_EQ(evidence.score().segment<3>(StarTrackerError), Vector3d::Zero());
}

TEST(AlignmentEvidence, OfAnExactFileTheSquareIsThatOfTheNoise) {
  AlignmentEvidence evidence{FilterAlignment::Zero()};
  const Vector3d off_rad{0.01, -0.02, 0.005};
  for (int i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(
        evidence.add<3>(off_rad, difference(), kNoise_rad * kNoise_rad * Matrix3d::Identity()),
        off_rad.squaredNorm() / (kNoise_rad * kNoise_rad));
  }
  EXPECT_FALSE(evidence.beyond());
}

/// The squares of 300 innovations have a mean of 1 and a standard deviation of 0.05.
TEST(AlignmentEvidence, ADifferenceAsStatedIsNoNoiseAndNoContradiction) {
  std::mt19937_64 rng{4611};
  AlignmentEvidence evidence{stated()};
  const Vector3d off_rad = std::hypot(kSun_rad, kField_rad) * Vector3d{1.5, -2.0, 1.0};
  EXPECT_NEAR(add(evidence, off_rad, 300, rng), 1.0, 0.2);
  EXPECT_FALSE(evidence.beyond());
}

TEST(AlignmentEvidence, ADifferenceBeyondNamesTheErrorThatIsLargest) {
  std::mt19937_64 rng{4612};
  AlignmentEvidence evidence{stated()};
  const double both_rad = std::hypot(kSun_rad, kField_rad);
  add(evidence, 6.0 * both_rad * Vector3d::UnitY(), 300, rng);
  const auto beyond = evidence.beyond();
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->key, "magnetometer_deg");
  // The magnetometer takes the share of its variance.
  EXPECT_NEAR(beyond->sigmas, 6.0 * kField_rad / both_rad, 0.3);
}

/// Errors that the stated covariance ties together differ by nothing.
TEST(AlignmentEvidence, AFullCovarianceKnowsADifferenceBetterThanItsTerms) {
  std::mt19937_64 rng{4613};
  FilterAlignment tied = stated();
  tied.block<3, 3>(SunSensorError, SunSensorError) = kField_rad * kField_rad * Matrix3d::Identity();
  tied.block<3, 3>(SunSensorError, MagnetometerError) =
      kField_rad * kField_rad * Matrix3d::Identity();
  tied.block<3, 3>(MagnetometerError, SunSensorError) =
      kField_rad * kField_rad * Matrix3d::Identity();
  AlignmentEvidence evidence{tied};
  EXPECT_NEAR(add(evidence, Vector3d::Constant(kNoise_rad), 300, rng), 2.0, 0.3);
}

}  // namespace spindrift::testing::alignment_evidence_test
