#include "pipelines/spin/mean/mean_axis.h"

#include <cmath>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing::mean_axis_test {

constexpr double kRounding = 1e-14;

Eigen::Vector3d at_deg(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& axes) {
  MeanAxis mean;
  for (const Eigen::Vector3d& axis : axes) {
    mean.add_fix(made_fix(axis, Eigen::Matrix2d::Identity()));
  }
  return mean.axis_icrf();
}

TEST(MeanAxis, OfOneFixIsThatFix) {
  Eigen::Matrix2d covariance_rad2;
  covariance_rad2 << 4e-6, 1e-6, 1e-6, 2e-6;
  MeanAxis mean;
  mean.add_fix(made_fix(at_deg(123.0, -45.0), covariance_rad2));
  EXPECT_EQ(mean.count(), 1U);
  EXPECT_LT(angle_between_rad(mean.axis_icrf(), at_deg(123.0, -45.0)), kRounding);
  EXPECT_LT((mean.covariance_rad2() - covariance_rad2).norm(), 1e-6 * kRounding);
}

TEST(MeanAxis, CrossesRightAscensionZero) {
  const RaDec place = ra_dec_of(mean_of({at_deg(359.0, 20.0), at_deg(1.0, 20.0)}));
  EXPECT_NEAR(std::sin(place.ra_rad), 0.0, kRounding);
  EXPECT_NEAR(std::cos(place.ra_rad), 1.0, kRounding);
}

TEST(MeanAxis, IsThePoleWhenTheFixesLieAroundIt) {
  for (const double dec_deg : {89.5, -89.5}) {
    const Eigen::Vector3d mean = mean_of({at_deg(10.0, dec_deg), at_deg(100.0, dec_deg),
                                          at_deg(190.0, dec_deg), at_deg(280.0, dec_deg)});
    EXPECT_NEAR(mean.z(), std::copysign(1.0, dec_deg), kRounding);
    EXPECT_NEAR(mean.head<2>().norm(), 0.0, kRounding);
  }
}

TEST(MeanAxis, CovarianceFallsWithTheNumberOfFixes) {
  const Eigen::Matrix2d covariance_rad2 = Eigen::Vector2d{4e-6, 1e-6}.asDiagonal();
  MeanAxis mean;
  for (int i = 0; i < 100; ++i) {
    mean.add_fix(made_fix(at_deg(200.0, 33.0), covariance_rad2));
  }
  EXPECT_LT((mean.covariance_rad2() - covariance_rad2 / 100.0).norm(), 1e-6 * kRounding);
}

TEST(MeanAxis, WeightsUnequalFixesForTheLeastVariance) {
  MeanAxis mean;
  mean.add_fix(made_fix(at_deg(200.0, 33.0), 4e-6 * Eigen::Matrix2d::Identity()));
  mean.add_fix(made_fix(at_deg(200.0, 33.0), 1e-6 * Eigen::Matrix2d::Identity()));
  EXPECT_LT((mean.covariance_rad2() - 0.8e-6 * Eigen::Matrix2d::Identity()).norm(),
            1e-6 * kRounding);
}

TEST(MeanAxis, CovarianceAcrossThePoleKeepsItsDirections) {
  // On opposite sides of the pole, 0.01 deg off, "east" points in opposite directions, and a
  // quarter turn away it is the other's north. The uncertainty of all is along the ICRF x axis.
  const Eigen::Vector3d uncertain_icrf = Eigen::Vector3d::UnitX();
  MeanAxis mean;
  for (const double ra_deg : {0.0, 90.0, 180.0, 270.0}) {
    const Eigen::Vector3d axis = at_deg(ra_deg, 89.99);
    const Eigen::Vector2d along = tangent_basis(axis).transpose() * uncertain_icrf;
    mean.add_fix(made_fix(axis, 1e-6 * along * along.transpose()));
  }
  const Eigen::Vector2d along = tangent_basis(mean.axis_icrf()).transpose() * uncertain_icrf;
  const Eigen::Matrix2d covariance_rad2 = mean.covariance_rad2();
  // The error is of second order in 0.01 deg.
  EXPECT_NEAR(along.dot(covariance_rad2 * along), 0.25e-6, 1e-6 * std::pow(0.01 * kRadPerDeg, 2));
  EXPECT_NEAR(covariance_rad2.trace(), 0.25e-6, 1e-6 * std::pow(0.01 * kRadPerDeg, 2));
}

TEST(MeanAxis, CovarianceIsTheScatterOfTheMean) {
  constexpr int kMeans = 1000;
  constexpr int kFixes = 25;
  const Eigen::Vector2d sigma_rad{2e-3, 5e-4};
  const Eigen::Matrix2d covariance_rad2 = sigma_rad.cwiseAbs2().asDiagonal();
  const Eigen::Vector3d truth = at_deg(0.01, 88.0);
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(truth);
  std::mt19937_64 rng{61};
  std::normal_distribution<double> normal;
  double squares = 0.0;
  for (int trial = 0; trial < kMeans; ++trial) {
    MeanAxis mean;
    for (int i = 0; i < kFixes; ++i) {
      const double east = normal(rng);
      const Eigen::Vector2d off_rad = sigma_rad.cwiseProduct(Eigen::Vector2d{east, normal(rng)});
      const Eigen::Vector3d axis = (truth + basis * off_rad).normalized();
      // The covariance is given in the tangent plane of the fix.
      const Eigen::Matrix2d turn = tangent_basis(axis).transpose() * basis;
      mean.add_fix(made_fix(axis, turn * covariance_rad2 * turn.transpose()));
    }
    const Eigen::Vector2d error_rad =
        tangent_basis(mean.axis_icrf()).transpose() * (truth - mean.axis_icrf());
    squares += normalised_square(error_rad, mean.covariance_rad2());
  }
  // Four standard deviations, sqrt(4000) each, of chi-square with 2000 degrees of freedom.
  EXPECT_NEAR(squares, 2.0 * kMeans, 4.0 * std::sqrt(4.0 * kMeans));
}

TEST(MeanAxis, KnowsWhenFixesScatterMoreThanTheyState) {
  constexpr double kSigma_rad = 1e-3;
  const Eigen::Vector3d truth = at_deg(200.0, -80.0);
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(truth);
  std::mt19937_64 rng{62};
  std::normal_distribution<double> normal{0.0, kSigma_rad};
  for (const double times : {1.0, 5.0}) {
    for (int trial = 0; trial < 100; ++trial) {
      MeanAxis mean;
      for (int count = 1; count <= 100; ++count) {
        const double east_rad = times * normal(rng);
        mean.add_fix(
            made_fix((truth + basis * Eigen::Vector2d{east_rad, times * normal(rng)}).normalized(),
                     kSigma_rad * kSigma_rad * Eigen::Matrix2d::Identity()));
        if (times == 1.0) {
          EXPECT_EQ(mean.excess_scatter(), 1.0) << count;
        }
      }
      if (times > 1.0) {
        // Four sigmas of chi-square with 198 degrees of freedom.
        EXPECT_NEAR(mean.excess_scatter() / (times * times), 1.0, 4.0 * std::sqrt(2.0 / 198.0));
      }
    }
  }
}

TEST(AxisWindow, IsEmptyBeforeTheFirstFixAndWhereFixesCancel) {
  AxisWindow window{10};
  EXPECT_FALSE(window.axis_icrf());
  window.add_fix(made_fix(Eigen::Vector3d::UnitX(), Eigen::Matrix2d::Identity()));
  EXPECT_TRUE(window.axis_icrf());
  window.add_fix(made_fix(-Eigen::Vector3d::UnitX(), Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(window.axis_icrf());
}

TEST(AxisWindow, ForgetsWhatLiesBeforeIt) {
  AxisWindow window{2};
  for (int i = 0; i < 3; ++i) {
    window.add_fix(made_fix(Eigen::Vector3d::Unit(i), Eigen::Matrix2d::Identity()));
  }
  const Eigen::Vector3d expected = Eigen::Vector3d{0.0, 1.0, 1.0}.normalized();
  EXPECT_LT((window.axis_icrf().value() - expected).norm(), kRounding);
}

}  // namespace spindrift::testing::mean_axis_test
