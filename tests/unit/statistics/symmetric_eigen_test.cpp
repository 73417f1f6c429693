#include "pipelines/statistics/symmetric_eigen.h"

#include <cmath>
#include <numbers>

#include "tests/support/matchers.h"

namespace spindrift::symmetric_eigen_test {

TEST(SymmetricEigen, OfASecondDifferenceIsTheClosedForm) {
  constexpr int kSize = 7;
  Eigen::MatrixXd matrix = 2.0 * Eigen::MatrixXd::Identity(kSize, kSize);
  matrix.diagonal(1).setConstant(-1.0);
  matrix.diagonal(-1).setConstant(-1.0);
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  for (int i = 0; i < kSize; ++i) {
    EXPECT_NEAR(eigen.values[i], 2.0 - 2.0 * std::cos((i + 1) * std::numbers::pi / (kSize + 1)),
                1e-14);
  }
}

TEST(SymmetricEigen, GivesTheMatrixAgain) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.row(0) << 4.0, -1.0, 0.5, 2.0;
  matrix.col(0) = matrix.row(0).transpose();
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  EXPECT_TRUE((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose())
                  .isApprox(matrix, 1e-14));
  EXPECT_TRUE((eigen.vectors.transpose() * eigen.vectors).isIdentity(1e-14));
}

}  // namespace spindrift::symmetric_eigen_test
