#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "tests/support/matchers.h"

namespace spindrift::attitude_difference_test {

constexpr double kRounding = 4e-15;

TEST(AttitudeDifference, CovariancesAreOfEachBodysAxes) {
  const Eigen::Quaterniond q_a{
      Eigen::AngleAxisd{1.0, Eigen::Vector3d{2.0, -1.0, 2.0}.normalized()}};
  // The body's y is along the other's x: 0.1 rad about it is two of its sigmas of 0.05.
  const Eigen::Quaterniond q_b = q_a * quaternion_by({0.0, 0.1, 0.0}) *
                                 Eigen::AngleAxisd{kQuarter_rad, Eigen::Vector3d::UnitZ()};
  const Eigen::Quaterniond q_c = q_a * quaternion_by({0.0, 0.1, 0.0});
  const Eigen::Matrix3d small = 1e-8 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d wide_y = Eigen::Vector3d{1e-8, 0.0025, 1e-8}.asDiagonal();
  const auto difference = attitude_difference({q_a, small}, {q_c, wide_y}).value();
  EXPECT_NEAR(difference.angle_rad, 0.1, kRounding);
  EXPECT_NEAR(difference.chi_square, 0.01 / (0.0025 + 1e-8), 1e-9);
  // After half a turn of the body, the error about the other's x is about this y.
  const Eigen::Matrix3d wide_x = Eigen::Vector3d{0.0025, 1e-8, 1e-8}.asDiagonal();
  const auto turned =
      attitude_difference({q_b, wide_x}, {q_b * Eigen::Quaterniond{-1, 0, 0, 0}, small}).value();
  EXPECT_NEAR(turned.angle_rad, 0.0, kRounding);
  EXPECT_NEAR(turned.chi_square, 0.0, kRounding);
}

TEST(AttitudeDifference, IsTheSameFromEitherSide) {
  const Eigen::Quaterniond q_a{Eigen::AngleAxisd{0.7, Eigen::Vector3d::UnitY()}};
  const Eigen::Quaterniond q_b = q_a * quaternion_by({0.3, -0.2, 1.1});
  const Eigen::Matrix3d one = Eigen::Vector3d{0.01, 0.02, 0.03}.asDiagonal();
  const Eigen::Matrix3d other = Eigen::Vector3d{0.3, 0.001, 0.05}.asDiagonal();
  const auto there = attitude_difference({q_a, one}, {q_b, other});
  const auto back = attitude_difference({q_b, other}, {q_a, one});
  ASSERT_TRUE(there && back);
  EXPECT_NEAR(there->angle_rad, back->angle_rad, kRounding);
  EXPECT_NEAR(there->chi_square, back->chi_square, 1e-10);
}

TEST(AttitudeDifference, OfThePaperIsNearlyAllYaw) {
  // Source: Li 2017, separation attitude against the launcher's, 3.9 deg in total.
  const auto q = [](double phi_deg, double theta_deg, double psi_deg) {
    return quaternion_of({phi_deg * kRadPerDeg, theta_deg * kRadPerDeg, psi_deg * kRadPerDeg});
  };
  const double sigma_rad = 0.5 * kRadPerDeg;
  const Eigen::Matrix3d covariance = sigma_rad * sigma_rad * Eigen::Matrix3d::Identity();
  const auto difference = attitude_difference({q(-0.5155, 1.3194, 176.0337), covariance},
                                              {q(0.229, 0.2869, 179.72), covariance})
                              .value();
  EXPECT_NEAR(degrees(difference.angle_rad), 3.9, 0.05);
  EXPECT_NEAR(difference.chi_square,
              difference.angle_rad * difference.angle_rad / (2.0 * sigma_rad * sigma_rad), 1e-9);
}

TEST(AttitudeDifference, WithoutAnyErrorThereIsNoMeasure) {
  const UncertainAttitude exact{Eigen::Quaterniond::Identity(), Eigen::Matrix3d::Zero()};
  EXPECT_EQ(attitude_difference(exact, exact).error().code, ErrorCode::InvalidInput);
}

}  // namespace spindrift::attitude_difference_test
