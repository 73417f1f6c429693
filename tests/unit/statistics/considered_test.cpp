#include "pipelines/statistics/considered.h"

#include <Eigen/Dense>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::considered_test {

/// Holds twenty equations in three unknowns and two parameters.
struct Equations {
  Eigen::Matrix<double, 20, 3> by_unknowns;
  Eigen::Matrix<double, 20, 2> by_parameters;
  Eigen::Matrix<double, 20, 1> right;
  Considered<3, 2> considered;
  Eigen::Matrix3d information;
  Eigen::Vector3d score;

  Equations() {
    std::mt19937_64 rng{3};
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(rng); };
    by_unknowns = by_unknowns.NullaryExpr(draw);
    by_parameters = by_parameters.NullaryExpr(draw);
    right = right.NullaryExpr(draw);
    considered.shared = by_unknowns.transpose() * by_parameters;
    considered.own = by_parameters.transpose() * by_parameters;
    considered.score = by_parameters.transpose() * right;
    information = by_unknowns.transpose() * by_unknowns;
    score = by_unknowns.transpose() * right;
  }
  /// Returns the covariance of r from noise and parameters.
  Eigen::MatrixXd covariance(const Eigen::Matrix2d& prior) const {
    return Eigen::MatrixXd::Identity(20, 20) + by_parameters * prior * by_parameters.transpose();
  }
};

/// Least squares weighted by the covariance of noise and parameters equal those with the parameters
/// eliminated.
TEST(Considered, EliminatedParametersAreCorrelatedNoise) {
  Equations of;
  Eigen::Matrix2d some;
  some << 0.5, 0.2, 0.2, 0.3;
  const Eigen::Matrix2d one_alone = Eigen::Vector2d{0.5, 0.0}.asDiagonal();
  for (const Eigen::Matrix2d& prior : {some, one_alone}) {
    const Eigen::MatrixXd weight = of.covariance(prior).inverse();
    Eigen::Matrix3d information = of.information;
    Eigen::Vector3d score = of.score;
    of.considered.eliminate(prior, information, score);
    EXPECT_LT((information - of.by_unknowns.transpose() * weight * of.by_unknowns).norm(), 1e-12);
    EXPECT_LT((score - of.by_unknowns.transpose() * weight * of.right).norm(), 1e-12);
    EXPECT_NEAR(of.considered.explained(prior),
                of.right.squaredNorm() - of.right.dot(weight * of.right), 1e-12);
  }
}

TEST(Considered, KnownParametersChangeNoBit) {
  Equations of;
  Eigen::Matrix3d information = of.information;
  Eigen::Vector3d score = of.score;
  of.considered.eliminate(Eigen::Matrix2d::Zero(), information, score);
  EXPECT_EQ(information, of.information);
  EXPECT_EQ(score, of.score);
  EXPECT_EQ(of.considered.explained(Eigen::Matrix2d::Zero()), 0.0);
}

}  // namespace spindrift::considered_test
