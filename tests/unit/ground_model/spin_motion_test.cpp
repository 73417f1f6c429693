/// The closed-form rotation of the body, compared with Euler's equations integrated in small steps.

#include "pipelines/ground_model/dynamics/spin_motion.h"

#include <numbers>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::spin_motion_test {

constexpr double kRate_rad_s = 2.0 * std::numbers::pi;

SpinMotion motion_of(const Nutation& nutation, const Coning& coning) {
  return {.axis_icrf = Eigen::Vector3d::UnitZ(),
          .rate_rad_s = kRate_rad_s,
          .rate_drift_rad_s2 = 0.0,
          .first_azimuth_rad = 0.7,
          .nutation = nutation,
          .coning = coning};
}

Eigen::Matrix3d R_axes_body(const SpinMotion& motion, double t_s) {
  return motion.R_axes_tipped(t_s) *
         Eigen::AngleAxisd{motion.azimuth_rad(t_s), Eigen::Vector3d::UnitZ()};
}

/// Holds attitude and angular velocity of a torque-free rigid body with I_t = 1.
struct RigidBody {
  Eigen::Vector4d q_axes_body;  ///< Order x, y, z, w.
  Eigen::Vector3d omega_body;

  RigidBody changed(const RigidBody& rate, double dt_s) const {
    return {q_axes_body + dt_s * rate.q_axes_body, omega_body + dt_s * rate.omega_body};
  }
  RigidBody rate(const Eigen::Vector3d& inertia) const {
    const Eigen::Quaterniond q{q_axes_body};
    const Eigen::Quaterniond omega{0.0, omega_body.x(), omega_body.y(), omega_body.z()};
    const Eigen::Vector3d torque = -omega_body.cross(inertia.cwiseProduct(omega_body));
    return {0.5 * (q * omega).coeffs(), torque.cwiseQuotient(inertia)};
  }
  void step(const Eigen::Vector3d& inertia, double dt_s) {
    const RigidBody k1 = rate(inertia);
    const RigidBody k2 = changed(k1, 0.5 * dt_s).rate(inertia);
    const RigidBody k3 = changed(k2, 0.5 * dt_s).rate(inertia);
    const RigidBody k4 = changed(k3, dt_s).rate(inertia);
    *this = changed(k1, dt_s / 6.0).changed(k2, dt_s / 3.0).changed(k3, dt_s / 3.0);
    *this = changed(k4, dt_s / 6.0);
    q_axes_body.normalize();
  }
};

TEST(SpinMotion, IsThatOfEulersEquations) {
  for (const double inertia_ratio : {0.05, 0.4, 0.9, 1.0, 1.3, 2.0}) {
    for (const double half_angle_deg : {0.2, 10.0}) {
      SCOPED_TRACE(::testing::Message() << inertia_ratio << ' ' << half_angle_deg);
      const Nutation nutation = {.half_angle_rad = half_angle_deg * kRadPerDeg,
                                 .inertia_ratio = inertia_ratio,
                                 .first_azimuth_rad = 2.0};
      const SpinMotion motion = motion_of(nutation, {});
      const Eigen::Vector3d inertia{1.0, 1.0, inertia_ratio};
      // The angular momentum is along the third axis. Its size follows from the stated rate: I_s
      // w_z = H cos h, and w_z = rate of phi + cos h times that of psi, with the sum of both rates
      // given.
      const Eigen::Matrix3d R_axes_body_0 = R_axes_body(motion, 0.0);
      const double cosine = std::cos(nutation.half_angle_rad);
      const double momentum = kRate_rad_s / (1.0 + cosine / inertia_ratio - cosine);
      const Eigen::Vector3d momentum_body =
          momentum * R_axes_body_0.transpose() * Eigen::Vector3d::UnitZ();
      RigidBody body = {.q_axes_body = Eigen::Quaterniond{R_axes_body_0}.coeffs(),
                        .omega_body = momentum_body.cwiseQuotient(inertia)};
      constexpr int kSteps = 40'000;
      constexpr double kStep_s = 20.0 / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        body.step(inertia, kStep_s);
      }
      const Eigen::Quaterniond expected{body.q_axes_body};
      EXPECT_LT(expected.angularDistance(Eigen::Quaterniond{R_axes_body(motion, 20.0)}), 1e-8);
    }
  }
}

TEST(SpinMotion, LeansAtTheStartWhereItIsSaidTo) {
  const SpinMotion motion = motion_of(
      {.half_angle_rad = 0.1, .inertia_ratio = 0.5, .first_azimuth_rad = 50.0 * kRadPerDeg}, {});
  const Eigen::Vector3d lean = motion.R_axes_tipped(0.0).col(2);
  EXPECT_NEAR(std::atan2(lean.y(), lean.x()), 50.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(lean.z(), std::cos(0.1), 1e-12);
}

TEST(SpinMotion, ConesAboutAnAxisFixedInTheBody) {
  const Nutation nutation = {.half_angle_rad = 0.05, .inertia_ratio = 0.4};
  const SpinMotion nutating = motion_of(nutation, {});
  const SpinMotion both = motion_of(nutation, {.tilt_rad = 0.02, .azimuth_rad = 0.3});
  // Positive azimuth behind slit 1 is to the right.
  const Eigen::Vector3d sensors_axis_body{std::sin(0.02) * std::cos(-0.3),
                                          std::sin(0.02) * std::sin(-0.3), std::cos(0.02)};
  for (const double t_s : {0.0, 0.13, 7.7}) {
    const Eigen::Vector3d sensors_axis = R_axes_body(both, t_s).col(2);
    EXPECT_LT((sensors_axis - R_axes_body(nutating, t_s) * sensors_axis_body).norm(), 1e-12);
    const Eigen::Matrix3d R_body_sensors =
        R_axes_body(nutating, t_s).transpose() * R_axes_body(both, t_s);
    EXPECT_NEAR(Eigen::AngleAxisd{R_body_sensors}.angle(), 0.02, 1e-9);
  }
}

TEST(SpinMotion, StandsExactlyUprightWhereNothingWobbles) {
  EXPECT_EQ(motion_of({}, {}).R_axes_tipped(12.3), Eigen::Matrix3d::Identity());
}

}  // namespace spindrift::spin_motion_test
