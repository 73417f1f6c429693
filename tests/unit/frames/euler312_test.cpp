#include "pipelines/frames/euler312.h"

#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"

namespace spindrift::euler312_test {

constexpr double kRounding = 4e-15;

Euler312 of_degrees(double phi_deg, double theta_deg, double psi_deg) {
  return {phi_deg * kRadPerDeg, theta_deg * kRadPerDeg, psi_deg * kRadPerDeg};
}

/// Returns the angles from matrix elements (Li 2017, eq. 7 and 9), which fail near the singularity.
Euler312 by_matrix_elements(const Eigen::Quaterniond& q) {
  const double q1 = q.x();
  const double q2 = q.y();
  const double q3 = q.z();
  const double q4 = q.w();
  const double r13 = 2.0 * (q1 * q3 - q4 * q2);
  const double r21 = 2.0 * (q1 * q2 - q4 * q3);
  const double r22 = q4 * q4 - q1 * q1 + q2 * q2 - q3 * q3;
  const double r23 = 2.0 * (q2 * q3 + q4 * q1);
  const double r33 = q4 * q4 - q1 * q1 - q2 * q2 + q3 * q3;
  return {std::asin(r23), std::atan2(-r13, r33), std::atan2(-r21, r22)};
}

TEST(Euler312, TurnsAboutZThenXThenY) {
  // After 90 deg about z the body's x is the reference's y.
  EXPECT_NEAR(
      (attitude_matrix(of_degrees(0, 0, 90)) * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitX())
          .norm(),
      0.0, kRounding);
  // After 90 deg about that x the body's z is the reference's x.
  EXPECT_NEAR(
      (attitude_matrix(of_degrees(90, 0, 90)) * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ())
          .norm(),
      0.0, kRounding);
  // Theta rotates about the body's own y.
  EXPECT_NEAR((attitude_matrix(of_degrees(90, 30, 90)) * Eigen::Vector3d::UnitX())
                  .dot(Eigen::Vector3d::UnitX()),
              -std::sin(30 * kRadPerDeg), kRounding);
}

TEST(Euler312, IsTheProductOfTheThreeMatrices) {
  const double phi = 0.4;
  const double theta = -2.0;
  const double psi = 2.7;
  Eigen::Matrix3d Ry;
  Ry << std::cos(theta), 0, -std::sin(theta), 0, 1, 0, std::sin(theta), 0, std::cos(theta);
  Eigen::Matrix3d Rx;
  Rx << 1, 0, 0, 0, std::cos(phi), std::sin(phi), 0, -std::sin(phi), std::cos(phi);
  Eigen::Matrix3d Rz;
  Rz << std::cos(psi), std::sin(psi), 0, -std::sin(psi), std::cos(psi), 0, 0, 0, 1;
  EXPECT_NEAR((attitude_matrix({phi, theta, psi}) - Ry * Rx * Rz).norm(), 0.0, kRounding);
}

TEST(Euler312, ReadsWhatTheElementsOfTheMatrixSay) {
  std::mt19937 rng{21};
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Quaterniond q =
        Eigen::Quaterniond{normal(rng), normal(rng), normal(rng), normal(rng)}.normalized();
    const Euler312Reading reading = euler312_of(q);
    if (reading.near_singular) {
      continue;
    }
    const Euler312 expected = by_matrix_elements(q);
    ASSERT_NEAR(reading.angles.phi_rad, expected.phi_rad, 1e-12);
    ASSERT_NEAR(reading.angles.theta_rad, expected.theta_rad, 1e-12);
    ASSERT_NEAR(reading.angles.psi_rad, expected.psi_rad, 1e-12);
  }
}

TEST(Euler312, AnglesOfThePaperComeBack) {
  for (const Euler312& angles :
       {of_degrees(38.403, 88.224, 118.045), of_degrees(31.011, 82.472, 162.749),
        of_degrees(46.064, 92.545, 119.929), of_degrees(-0.5155, 1.3194, 176.0337)}) {
    const Euler312Reading reading = euler312_of(quaternion_of(angles));
    EXPECT_FALSE(reading.near_singular);
    EXPECT_NEAR(reading.angles.phi_rad, angles.phi_rad, kRounding);
    EXPECT_NEAR(reading.angles.theta_rad, angles.theta_rad, kRounding);
    EXPECT_NEAR(reading.angles.psi_rad, angles.psi_rad, kRounding);
  }
}

TEST(Euler312, AtTheSingularityTheAttitudeIsKeptAndTheReadingSaysSo) {
  for (const double phi_deg : {90.0, 90.0 - 1e-10, 89.9, 89.01, -90.0, -89.5}) {
    for (const double theta_deg : {-170.0, 0.0, 35.0}) {
      for (const double psi_deg : {-60.0, 0.0, 144.0}) {
        const Eigen::Quaterniond q = quaternion_of(of_degrees(phi_deg, theta_deg, psi_deg));
        const Euler312Reading reading = euler312_of(q);
        EXPECT_TRUE(reading.near_singular);
        EXPECT_NEAR(angle_between_rad(quaternion_of(reading.angles), q), 0.0, 2e-15)
            << phi_deg << ' ' << theta_deg << ' ' << psi_deg;
        const double turns = (phi_deg > 0.0 ? theta_deg + psi_deg : theta_deg - psi_deg) / 360.0;
        const double read_turns =
            (reading.angles.theta_rad + std::copysign(1.0, phi_deg) * reading.angles.psi_rad) /
            kTurn_rad;
        EXPECT_NEAR(std::remainder(turns - read_turns, 1.0), 0.0, kRounding);
      }
    }
  }
  EXPECT_FALSE(euler312_of(quaternion_of(of_degrees(88.9, 10, 20))).near_singular);
}

TEST(Euler312, ConstantRateOfThePaperLeadsBackToSeparation) {
  // Source: Li 2017, 60 s back from T2 at the constant rate.
  const Eigen::Quaterniond q_t2 = quaternion_of(of_degrees(38.403, 88.224, 118.045));
  const Eigen::Vector3d rate_rad_s = Eigen::Vector3d{0.618844, -0.33139, 0.065912} * kRadPerDeg;
  const Euler312 t1 = euler312_of(q_t2 * quaternion_by(-60.0 * rate_rad_s)).angles;
  EXPECT_NEAR(degrees(t1.phi_rad), 31.024, 6e-4);
  EXPECT_NEAR(degrees(t1.theta_rad), 82.399, 6e-4);
  EXPECT_NEAR(degrees(t1.psi_rad), 162.793, 6e-4);
}

}  // namespace spindrift::euler312_test
