#include "pipelines/frames/celestial.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::celestial_test {

constexpr double kPi = std::numbers::pi;
// A few ulps of a number between 1 and 2 pi.
constexpr double kRounding = 4e-15;

Eigen::Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng);
  const double y = normal(rng);
  return Eigen::Vector3d{x, y, normal(rng)}.normalized();
}

TEST(Celestial, AxesHaveTheirPlaces) {
  EXPECT_NEAR((direction_icrf({0.0, 0.0}) - Eigen::Vector3d::UnitX()).norm(), 0.0, kRounding);
  EXPECT_NEAR((direction_icrf({kPi / 2, 0.0}) - Eigen::Vector3d::UnitY()).norm(), 0.0, kRounding);
  EXPECT_NEAR((direction_icrf({1.0, kPi / 2}) - Eigen::Vector3d::UnitZ()).norm(), 0.0, kRounding);
}

TEST(Celestial, SpinAxisOfGms5IsWhereItsPublishedPlaceSays) {
  const Eigen::Vector3d axis =
      direction_icrf({54.85810921211307 * kRadPerDeg, -89.47037755812647 * kRadPerDeg});
  EXPECT_NEAR(axis.norm(), 1.0, kRounding);
  // sin(-89.47037755812647 deg) and tan(54.85810921211307 deg) from Python's math module.
  EXPECT_NEAR(axis.z(), -0.9999572777215963, kRounding);
  // The quotient of two components of size 0.005 keeps their relative accuracy.
  EXPECT_NEAR(axis.y() / axis.x(), 1.4206470516192753, kRounding);
}

TEST(Celestial, PlaceOfADirectionLeadsBackToIt) {
  std::mt19937 rng{1};
  for (int trial = 0; trial < 5000; ++trial) {
    const Eigen::Vector3d direction = random_direction(rng);
    const RaDec place = ra_dec_of(7.5 * direction);
    ASSERT_GE(place.ra_rad, 0.0);
    ASSERT_LT(place.ra_rad, 2 * kPi);
    ASSERT_LE(std::abs(place.dec_rad), kPi / 2);
    ASSERT_NEAR((direction_icrf(place) - direction).norm(), 0.0, kRounding);
  }
}

TEST(Celestial, RightAscensionStaysBelowAFullTurn) {
  EXPECT_EQ(ra_dec_of({1.0, -1e-300, 0.0}).ra_rad, 0.0);
  EXPECT_NEAR(ra_dec_of({1.0, -1e-9, 0.0}).ra_rad, 2 * kPi - 1e-9, kRounding);
}

TEST(Celestial, RightAscensionAtThePolesIsZero) {
  for (const double z : {1.0, -3.0}) {
    const RaDec place = ra_dec_of({-0.0, 0.0, z});
    EXPECT_EQ(place.ra_rad, 0.0);
    EXPECT_EQ(place.dec_rad, std::copysign(kPi / 2, z));
  }
}

TEST(Celestial, AngleBetweenIsExactWhereTheCosineIsBlind) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  EXPECT_NEAR(angle_between_rad(x, {1.0, 1e-12, 0.0}), 1e-12, 1e-27);
  EXPECT_NEAR(angle_between_rad(5.0 * x, {-2.0, 2e-9, 0.0}), kPi - 1e-9, kRounding);
  EXPECT_EQ(angle_between_rad(x, 3.0 * x), 0.0);
  EXPECT_EQ(angle_between_rad(x, -x), kPi);
}

TEST(Celestial, AngleBetweenIsThatOfTheRotation) {
  std::mt19937 rng{2};
  std::uniform_real_distribution<double> any_angle_rad{0.0, kPi};
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d a = random_direction(rng);
    const Eigen::Vector3d normal = a.cross(random_direction(rng)).normalized();
    const double angle_rad = any_angle_rad(rng);
    const Eigen::Vector3d b = Eigen::AngleAxisd{angle_rad, normal} * a;
    ASSERT_NEAR(angle_between_rad(a, b), angle_rad, kRounding);
  }
}

TEST(Celestial, TangentBasisIsEastAndNorth) {
  std::mt19937 rng{3};
  constexpr double kStep_rad = 1e-6;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d axis = random_direction(rng);
    const auto basis = tangent_basis(2.0 * axis);
    ASSERT_NEAR((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), 0.0, kRounding);
    ASSERT_NEAR((basis.transpose() * axis).norm(), 0.0, kRounding);
    // A small step north raises the declination by the step, up to second order times tan dec.
    const RaDec here = ra_dec_of(axis);
    const RaDec north = ra_dec_of(axis + kStep_rad * basis.col(1));
    const double tangent = std::tan(here.dec_rad);
    ASSERT_NEAR(north.dec_rad - here.dec_rad, kStep_rad, 1e-12 * (1.0 + std::abs(tangent)));
    ASSERT_GT(basis.col(0).dot(Eigen::Vector3d{-axis.y(), axis.x(), 0.0}), 0.0);
  }
}

TEST(Celestial, TangentBasisAtThePolesIsThatOfRightAscensionZero) {
  const auto north = tangent_basis(Eigen::Vector3d::UnitZ());
  EXPECT_EQ(north.col(0), Eigen::Vector3d::UnitY());
  EXPECT_EQ(north.col(1), -Eigen::Vector3d::UnitX());
  const auto south = tangent_basis(-Eigen::Vector3d::UnitZ());
  EXPECT_EQ(south.col(0), Eigen::Vector3d::UnitY());
  EXPECT_EQ(south.col(1), Eigen::Vector3d::UnitX());
}

TEST(Celestial, WrappedAngleLiesInTheHalfOpenTurn) {
  EXPECT_EQ(wrapped_rad(0.0), 0.0);
  EXPECT_EQ(wrapped_rad(kPi), kPi);
  EXPECT_EQ(wrapped_rad(-kPi), kPi);
  EXPECT_NEAR(wrapped_rad(3.0 * kPi / 2.0), -kPi / 2.0, kRounding);
  std::mt19937 rng{4};
  std::uniform_real_distribution<double> any_rad{-100.0, 100.0};
  for (int trial = 0; trial < 5000; ++trial) {
    const double angle_rad = any_rad(rng);
    const double wrapped = wrapped_rad(angle_rad);
    ASSERT_GT(wrapped, -kPi);
    ASSERT_LE(wrapped, kPi);
    ASSERT_NEAR(std::sin(wrapped), std::sin(angle_rad), 1e-13);
    ASSERT_NEAR(std::cos(wrapped), std::cos(angle_rad), 1e-13);
  }
}

}  // namespace spindrift::celestial_test
