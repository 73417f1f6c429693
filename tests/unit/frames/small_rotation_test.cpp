#include <cmath>
#include <numbers>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"

namespace spindrift::small_rotation_test {

TEST(RotationBy, TurnsAboutTheVectorByItsLength) {
  EXPECT_EQ(rotation_by(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d quarter = rotation_by({0.0, 0.0, 0.5 * std::numbers::pi});
  EXPECT_TRUE((quarter * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_EQ(rotation_by({1e-100, 0.0, 0.0})(2, 1), 1e-100);
}

TEST(RotationPerVector, IsTheSlopeToItsThirdPower) {
  constexpr double kStep_rad = 1e-6;
  for (const double size_deg : {0.01, 1.0, 5.0}) {
    const double size_rad = size_deg * kRadPerDeg;
    const Eigen::Vector3d vector_rad = size_rad * Eigen::Vector3d{0.36, -0.48, 0.8};
    const Eigen::Matrix3d slopes = rotation_per_vector(vector_rad);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step_rad = kStep_rad * Eigen::Vector3d::Unit(i);
      const Eigen::Matrix3d ahead =
          rotation_by(vector_rad + step_rad) * rotation_by(vector_rad - step_rad).transpose();
      const Eigen::Vector3d turned_rad =
          rotation_vector_of(Eigen::Quaterniond{ahead}) / (2.0 * kStep_rad);
      EXPECT_LT((turned_rad - slopes.col(i)).norm(), std::pow(size_rad, 3) / 24.0 + 1e-9);
    }
  }
}

}  // namespace spindrift::small_rotation_test
