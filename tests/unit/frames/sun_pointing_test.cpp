#include "pipelines/frames/sun_pointing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"

namespace spindrift::sun_pointing_test {

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 4e-15;

Eigen::Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng);
  const double y = normal(rng);
  return Eigen::Vector3d{x, y, normal(rng)}.normalized();
}

TEST(SunPointing, IsZeroWhereMinusZLooksAtTheSun) {
  const SunPointing pointing = sun_pointing_of({0.0, 0.0, -2.0});
  EXPECT_EQ(pointing.phi_rad, 0.0);
  EXPECT_EQ(pointing.theta_rad, 0.0);
}

TEST(SunPointing, AgreesWithThePaperWhereItsEquationsHold) {
  // Equations 5 and 6 of the paper hold for sz > 0.
  for (const double sy : {0.4, -0.4}) {
    for (const double sx : {0.3, -0.3}) {
      const double sz = 0.8;
      const SunPointing pointing = sun_pointing_of({sx, sy, sz});
      EXPECT_NEAR(pointing.phi_rad, std::atan(sy / sz) + (sy >= 0.0 ? -kPi : kPi), kRounding);
      EXPECT_NEAR(pointing.theta_rad, (sx >= 0.0 ? kPi : -kPi) - std::atan(sx / sz), kRounding);
    }
  }
  // From -z, phi is negative towards +y, and theta is positive towards +x.
  EXPECT_LT(sun_pointing_of({0.0, 0.1, -1.0}).phi_rad, 0.0);
  EXPECT_GT(sun_pointing_of({0.1, 0.0, -1.0}).theta_rad, 0.0);
}

TEST(SunPointing, LeadsBackToTheDirection) {
  std::mt19937 rng{31};
  for (int trial = 0; trial < 5000; ++trial) {
    const Eigen::Vector3d sun = random_direction(rng);
    const auto back = sun_body_of(sun_pointing_of(3.0 * sun));
    ASSERT_TRUE(back);
    ASSERT_NEAR((*back - sun).norm(), 0.0, 1e-13 / std::abs(sun.z()));
  }
}

TEST(SunPointing, AnglesOfNoDirectionAreRefused) {
  EXPECT_EQ(sun_body_of({0.2, 3.0}).error().code, ErrorCode::InvalidInput);
  EXPECT_EQ(sun_body_of({kPi / 2.0, kPi / 2.0}).error().code, ErrorCode::Unobservable);
  EXPECT_EQ(sun_body_of(sun_pointing_of({0.6, 0.8, 0.0})).error().code, ErrorCode::Unobservable);
}

TEST(SunPointing, CorrectsTheAttitudeByTheLeastTurn) {
  std::mt19937 rng{32};
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Quaterniond q{
        Eigen::AngleAxisd{3.0 * random_direction(rng).x(), random_direction(rng)}};
    const Eigen::Vector3d sun_ref = random_direction(rng);
    const Eigen::Vector3d sun_body = random_direction(rng);
    const auto corrected = attitude_with(sun_pointing_of(sun_body), q, sun_ref);
    ASSERT_TRUE(corrected);
    ASSERT_NEAR((corrected->conjugate() * sun_ref - sun_body).norm(), 0.0,
                1e-13 / std::abs(sun_body.z()));
    // No attitude that has the Sun there is nearer.
    const double turned_rad = angle_between_rad(q, *corrected);
    ASSERT_NEAR(turned_rad, angle_between_rad(q.conjugate() * sun_ref, sun_body), 1e-7);
    for (const double about_sun_rad : {-0.01, 0.01}) {
      const Eigen::Quaterniond other = *corrected * quaternion_by(about_sun_rad * sun_body);
      ASSERT_GE(angle_between_rad(q, other), turned_rad);
    }
  }
}

}  // namespace spindrift::sun_pointing_test
