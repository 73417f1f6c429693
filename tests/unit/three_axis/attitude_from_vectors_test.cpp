#include "pipelines/three_axis/attitude_from_vectors.h"

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::attitude_from_vectors_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Source: Schaub and Junkins, Analytical Mechanics of Space Systems, examples 3.14 to 3.16 and
// concept checks. The matrices rotate the reference into the body, with eight digits.
const ObservedDirection kFirst{{0.8190, -0.5282, 0.2242}, Vector3d::UnitX(), 0.01};
const ObservedDirection kSecond{{-0.3138, -0.1584, 0.9362}, Vector3d::UnitZ(), 0.01};
const ObservedDirection kFirstNear180{{0.8273, 0.5541, -0.0920}, {-0.1517, -0.9669, 0.2050}, 0.01};
const ObservedDirection kSecondNear180{
    {-0.8285, 0.5522, -0.0955}, {-0.8393, 0.4494, -0.3044}, 0.01 * std::numbers::sqrt2};
constexpr double kPublished = 1e-8;

Matrix3d rows(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
  Matrix3d matrix;
  matrix << x.transpose(), y.transpose(), z.transpose();
  return matrix;
}

Matrix3d body_from_ref(const Expected<UncertainAttitude>& attitude) {
  return attitude.value().q_ref_body.conjugate().toRotationMatrix();
}

/// Returns the principal rotation between an estimate and the truth, deg.
double error_deg(const Matrix3d& estimate) {
  // 3-2-1 angles: 30 deg about z, 20 about y, -10 about x.
  const Eigen::Quaterniond q_ref_body = Eigen::AngleAxisd{30.0 * kRadPerDeg, Vector3d::UnitZ()} *
                                        Eigen::AngleAxisd{20.0 * kRadPerDeg, Vector3d::UnitY()} *
                                        Eigen::AngleAxisd{-10.0 * kRadPerDeg, Vector3d::UnitX()};
  return degrees(Eigen::AngleAxisd{estimate * q_ref_body.toRotationMatrix()}.angle());
}

TEST(Triad, IsThatOfTheBook) {
  const Matrix3d attitude = body_from_ref(triad(kFirst, kSecond));
  const Matrix3d published =
      rows({0.81899104, 0.45928237, -0.34396712}, {-0.52819422, 0.83763943, -0.13917991},
           {0.22419755, 0.29566855, 0.92860948});
  EXPECT_NEAR((attitude - published).cwiseAbs().maxCoeff(), 0.0, kPublished);
  EXPECT_NEAR(error_deg(attitude), 1.8525322, 1e-7);
}

TEST(Triad, NearAHalfTurnItIsThatOfTheBook) {
  const Matrix3d published =
      rows({0.41555875, -0.85509088, 0.31004921}, {-0.83393233, -0.49427603, -0.24545471},
           {0.36313597, -0.15655922, -0.91848869});
  EXPECT_NEAR(
      (body_from_ref(triad(kFirstNear180, kSecondNear180)) - published).cwiseAbs().maxCoeff(), 0.0,
      5e-8);
}

TEST(QMethod, IsThatOfTheBook) {
  const auto attitude = q_method(std::array{kFirst, kSecond});
  const Matrix3d published =
      rows({0.82514287, 0.45928237, -0.32893608}, {-0.52556132, 0.83763943, -0.14881358},
           {0.20718237, 0.29566855, 0.93255326});
  EXPECT_NEAR((body_from_ref(attitude) - published).cwiseAbs().maxCoeff(), 0.0, kPublished);
  EXPECT_NEAR(error_deg(body_from_ref(attitude)), 1.6959735, 1e-7);
  const Eigen::Quaterniond q{0.94806851, -0.11720728, 0.14137123, 0.2596974};
  EXPECT_NEAR(angle_between_rad(attitude->q_ref_body, q), 0.0, 2e-8);
}

TEST(QMethod, NearAHalfTurnItIsThatOfTheBook) {
  // The weights in the book are 2 and 1.
  const auto attitude = q_method(std::array{kFirstNear180, kSecondNear180});
  const Matrix3d published =
      rows({0.41581051, -0.85495933, 0.31007444}, {-0.83381526, -0.49451654, -0.24536812},
           {0.3631167, -0.15651815, -0.91850331});
  EXPECT_NEAR((body_from_ref(attitude) - published).cwiseAbs().maxCoeff(), 0.0, kPublished);
}

TEST(QMethod, OfEqualWeightsNearAHalfTurnItIsTheReferenceQuaternion) {
  ObservedDirection second = kSecondNear180;
  second.sigma_rad = kFirstNear180.sigma_rad;
  const auto attitude = q_method(std::array{kFirstNear180, second});
  const Eigen::Quaterniond q{-0.026405, 0.840994, -0.501980, 0.200119};
  EXPECT_NEAR(angle_between_rad(attitude.value().q_ref_body, q), 0.0, 2e-6);
}

TEST(QMethod, OfExactDirectionsItIsExact) {
  std::mt19937_64 rng{51};
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Quaterniond truth = any_attitude(rng);
    std::vector<ObservedDirection> directions;
    for (int i = 0; i < 5; ++i) {
      const Vector3d ref = normal_vector(rng, 1.0);
      directions.push_back({truth.conjugate() * ref, 3.0 * ref, 0.001});
    }
    const auto attitude = q_method(directions).value();
    ASSERT_NEAR(angle_between_rad(attitude.q_ref_body, truth), 0.0, 1e-12);
    ASSERT_NEAR(angle_between_rad(triad(directions[0], directions[1]).value().q_ref_body, truth),
                0.0, 1e-12);
  }
}

TEST(QMethod, FindsTheHalfTurn) {
  for (const Vector3d& axis :
       {Vector3d{Vector3d::UnitX()}, Vector3d{Vector3d::UnitY()}, Vector3d{Vector3d::UnitZ()}}) {
    const Eigen::Quaterniond truth{Eigen::AngleAxisd{std::numbers::pi, axis}};
    const Vector3d one{1.0, 2.0, 3.0};
    const Vector3d other{-2.0, 0.5, 1.0};
    const auto attitude =
        q_method(std::array{ObservedDirection{truth.conjugate() * one, one, 0.01},
                            ObservedDirection{truth.conjugate() * other, other, 0.01}});
    EXPECT_NEAR(angle_between_rad(attitude.value().q_ref_body, truth), 0.0, 1e-12);
  }
}

TEST(AttitudeFromVectors, InLineTheTurnAboutTheLineIsOpen) {
  const ObservedDirection along{{1.0, 1.0, 0.0}, {0.0, 0.0, 2.0}, 0.01};
  const ObservedDirection against{{-1.0, -1.0, 0.0}, {0.0, 0.0, -1.0}, 0.01};
  const ObservedDirection nearly{{1.0, 1.005, 0.0}, {0.0, 0.0025, 1.0}, 0.01};
  for (const ObservedDirection& other : {along, against, nearly}) {
    EXPECT_THAT(q_method(std::array{along, other}), IsRefused(ErrorCode::Unobservable, _));
    EXPECT_EQ(triad(along, other).error().code, ErrorCode::Unobservable);
  }
  EXPECT_EQ(q_method(std::array{along}).error().code, ErrorCode::Unobservable);
  EXPECT_EQ(q_method({}).error().code, ErrorCode::Unobservable);
  // With a sigma of a thousandth of a degree the same two suffice.
  ObservedDirection sharp = along;
  ObservedDirection sharp_nearly = nearly;
  sharp.sigma_rad = sharp_nearly.sigma_rad = 2e-5;
  EXPECT_TRUE(q_method(std::array{sharp, sharp_nearly}));
}

/// Checks the mean NEES and the ratio of the mean covariance to that of the errors over 4,000
/// draws.
void expect_honest(
    const std::function<Expected<UncertainAttitude>(std::span<const ObservedDirection>)>& solve) {
  std::mt19937_64 rng{52};
  const std::array<Vector3d, 2> refs = {Vector3d{1.0, 0.0, 0.2}.normalized(),
                                        Vector3d{0.6, 0.7, 0.0}.normalized()};
  const std::array<double, 2> sigmas_rad = {0.002, 0.01};
  const Eigen::Quaterniond truth = any_attitude(rng);
  constexpr int kDraws = 4000;
  double squared = 0.0;
  Matrix3d scatter = Matrix3d::Zero();
  Matrix3d stated = Matrix3d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    std::array<ObservedDirection, 2> directions;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector3d body = truth.conjugate() * refs.at(i);
      directions.at(i) = {body + sigmas_rad.at(i) * body.cross(normal_vector(rng, 1.0)), refs.at(i),
                          sigmas_rad.at(i)};
    }
    const UncertainAttitude attitude = solve(directions).value();
    const Vector3d error = error_rad(attitude.q_ref_body, truth);
    squared += error.dot(attitude.covariance_rad2.inverse() * error) / kDraws;
    scatter += error * error.transpose() / kDraws;
    stated += attitude.covariance_rad2 / kDraws;
  }
  // The mean of 4,000 chi-squares of 3 has a standard deviation of 0.039.
  EXPECT_NEAR(squared, 3.0, 0.12);
  EXPECT_NEAR((stated.inverse() * scatter).trace(), 3.0, 0.12);
}

TEST(Triad, CovarianceIsThatOfItsErrors) {
  expect_honest([](std::span<const ObservedDirection> directions) {
    return triad(directions[0], directions[1]);
  });
}

TEST(QMethod, CovarianceIsThatOfItsErrors) { expect_honest(&q_method); }

}  // namespace spindrift::testing::attitude_from_vectors_test
