#include "pipelines/frames/rotation_vector.h"

#include <numbers>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::rotation_vector_test {

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 4e-15;

Eigen::Vector3d random_vector(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng);
  const double y = normal(rng);
  return Eigen::Vector3d{x, y, normal(rng)};
}

TEST(RotationVector, CrossMatrixIsTheCrossProduct) {
  const Eigen::Vector3d a{1.0, -2.0, 3.0};
  const Eigen::Vector3d b{0.5, 4.0, -1.0};
  EXPECT_EQ(cross_matrix(a) * b, a.cross(b));
}

TEST(RotationVector, TurnsByTheAngleAboutTheAxis) {
  std::mt19937 rng{11};
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d axis = random_vector(rng).normalized();
    for (const double angle_rad : {0.0, 1e-12, 9.99e-4, 1.001e-3, 0.3, 3.0, 7.0}) {
      const Eigen::Quaterniond q = quaternion_by(angle_rad * axis);
      const Eigen::Quaterniond truth{Eigen::AngleAxisd{angle_rad, axis}};
      ASSERT_NEAR((q.coeffs() - truth.coeffs()).norm(), 0.0, kRounding) << angle_rad;
    }
  }
}

TEST(RotationVector, ComesBackFromItsQuaternionOfEitherSignAndAnyLength) {
  std::mt19937 rng{12};
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d axis = random_vector(rng).normalized();
    for (const double angle_rad : {1e-12, 1e-3, 1.0, 3.14}) {
      Eigen::Quaterniond q = quaternion_by(angle_rad * axis);
      q.coeffs() *= -2.5;
      ASSERT_NEAR((rotation_vector_of(q) - angle_rad * axis).norm(), 0.0, kRounding) << angle_rad;
    }
  }
  EXPECT_EQ(rotation_vector_of(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero());
  EXPECT_NEAR(rotation_vector_of({0.0, 0.0, 1.0, 0.0}).norm(), kPi, kRounding);
}

TEST(RotationVector, RightJacobianIsWhatAChangeOfTheVectorTurnsBy) {
  std::mt19937 rng{13};
  constexpr double kStep_rad = 1e-5;
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d axis = random_vector(rng).normalized();
    for (const double angle_rad : {0.0, 1e-4, 9.9e-3, 1.01e-2, 0.5, 2.5}) {
      const Eigen::Vector3d vector_rad = angle_rad * axis;
      const Eigen::Vector3d step_rad = kStep_rad * random_vector(rng).normalized();
      const Eigen::Vector3d turned_rad =
          0.5 * rotation_vector_of(quaternion_by(vector_rad - step_rad).conjugate() *
                                   quaternion_by(vector_rad + step_rad));
      ASSERT_NEAR((turned_rad - right_jacobian(vector_rad) * step_rad).norm(), 0.0,
                  2e-10 * kStep_rad + 4e-15)
          << angle_rad;
    }
  }
}

TEST(RotationVector, InverseRightJacobianIsItsInverse) {
  std::mt19937 rng{14};
  for (int trial = 0; trial < 1000; ++trial) {
    for (const double angle_rad : {0.0, 1e-4, 9.9e-3, 1.01e-2, 0.5, 3.1}) {
      const Eigen::Vector3d vector_rad = angle_rad * random_vector(rng).normalized();
      const Eigen::Matrix3d product =
          inverse_right_jacobian(vector_rad) * right_jacobian(vector_rad);
      ASSERT_NEAR((product - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-10) << angle_rad;
    }
  }
}

TEST(RotationVector, AngleBetweenAttitudesIsThatOfTheTurn) {
  const Eigen::Quaterniond a{Eigen::AngleAxisd{1.0, Eigen::Vector3d{1.0, 2.0, 2.0} / 3.0}};
  const Eigen::Quaterniond b = a * quaternion_by({0.0, 0.25, 0.0});
  EXPECT_NEAR(angle_between_rad(a, b), 0.25, kRounding);
  EXPECT_NEAR(angle_between_rad(a, Eigen::Quaterniond{-b.coeffs()}), 0.25, kRounding);
}

}  // namespace spindrift::rotation_vector_test
