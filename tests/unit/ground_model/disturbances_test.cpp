#include "pipelines/ground_model/dynamics/disturbances.h"

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/frames/wgs84.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_body.h"

namespace spindrift::disturbances_test {

using Eigen::Vector3d;

const Eigen::Matrix3d kInertia_kg_m2 = Vector3d{80.0, 100.0, 60.0}.asDiagonal();
constexpr double kRadius_km = 7000.0;
const double kRate_rad_s = std::sqrt(kEarthMu_km3_s2 / (kRadius_km * kRadius_km * kRadius_km));

/// Returns the surroundings in an equatorial orbit.
Surroundings after(double t_s) {
  const double angle_rad = kRate_rad_s * t_s;
  return {.spacecraft = {.position_icrf_km =
                             kRadius_km * Vector3d{std::cos(angle_rad), std::sin(angle_rad), 0.0},
                         .velocity_icrf_km_s =
                             kRadius_km * kRate_rad_s *
                             Vector3d{-std::sin(angle_rad), std::cos(angle_rad), 0.0}},
          .field_icrf_nt = {0.0, 0.0, 30'000.0}};
}

TEST(Disturbances, AreNoneWhereNoneIsSaid) {
  EXPECT_EQ(disturbance_body_nm({}, kInertia_kg_m2, {}, Eigen::Quaterniond::Identity(), 3.0),
            Vector3d::Zero());
}

TEST(Disturbances, TurnTheSlightlyLeaningBodyUprightByGravityGradient) {
  constexpr double kLean_rad = 0.01;
  const Disturbances gravity{.gravity_gradient = true};
  const Vector3d torque_nm = disturbance_body_nm(gravity, kInertia_kg_m2, after(0.0),
                                                 quaternion_by({0.0, 0.0, kLean_rad}), 0.0);
  const double expected_nm =
      -3.0 * kRate_rad_s * kRate_rad_s * (100.0 - 80.0) * std::sin(kLean_rad) * std::cos(kLean_rad);
  EXPECT_LT((torque_nm - Vector3d{0.0, 0.0, expected_nm}).norm(), 1e-12 * std::abs(expected_nm));
}

// The pitch frequency is n sqrt(3 (I_roll - I_yaw) / I_pitch), with yaw along the radius.
TEST(Disturbances, LetTheBodyLibrateAsAnOrbitingPendulum) {
  constexpr double kStep_s = 1.0;
  constexpr double kAtFirst_rad = 0.001;
  SteppedBody body{RigidBody::make(kInertia_kg_m2).value(),
                   {.q_icrf_body = quaternion_by({0.0, 0.0, kAtFirst_rad}),
                    .rate_body_rad_s = {0.0, 0.0, kRate_rad_s}},
                   kStep_s};
  const double expected_rad_s = kRate_rad_s * std::sqrt(3.0 * (100.0 - 80.0) / 60.0);
  for (int i = 0; i < 6000; ++i) {
    const double t_s = i * kStep_s;
    const double lean_rad =
        rotation_vector_of(quaternion_by({0.0, 0.0, -kRate_rad_s * t_s}) * body.last().q_icrf_body)
            .z();
    ASSERT_NEAR(lean_rad, kAtFirst_rad * std::cos(expected_rad_s * t_s), 2e-6) << t_s;
    body.step({.external_nm = disturbance_body_nm({.gravity_gradient = true}, kInertia_kg_m2,
                                                  after(t_s), body.last().q_icrf_body, t_s)});
  }
}

TEST(Disturbances, DragTheCentreOfPressureAgainstTheAir) {
  const Disturbances drag{.drag = Drag{.atmosphere = {.density_kg_m3 = 1e-12},
                                       .area_m2 = 2.0,
                                       .coefficient = 2.2,
                                       .centre_of_pressure_body_m = {0.1, 0.0, 0.0}}};
  const Vector3d torque_nm =
      disturbance_body_nm(drag, kInertia_kg_m2, after(0.0), Eigen::Quaterniond::Identity(), 0.0);
  const double speed_m_s = 1000.0 * kRadius_km * (kRate_rad_s - wgs84::kTurning_rad_s);
  const double force_n = 0.5 * 1e-12 * 2.0 * 2.2 * speed_m_s * speed_m_s;
  EXPECT_LT((torque_nm - Vector3d{0.0, 0.0, -0.1 * force_n}).norm(), 1e-12 * force_n);
}

TEST(Disturbances, FindThinnerAirAScaleHeightHigher) {
  const auto drag_at = [](double altitude_km) {
    const Disturbances drag{.drag = Drag{.atmosphere = {.density_kg_m3 = 1e-12,
                                                        .altitude_km = altitude_km,
                                                        .scale_height_km = 60.0},
                                         .area_m2 = 2.0,
                                         .coefficient = 2.2,
                                         .centre_of_pressure_body_m = {0.1, 0.0, 0.0}}};
    return disturbance_body_nm(drag, kInertia_kg_m2, after(0.0), Eigen::Quaterniond::Identity(),
                               0.0)
        .norm();
  };
  EXPECT_NEAR(drag_at(560.0) / drag_at(500.0), std::exp(1.0), 1e-12);
}

TEST(Disturbances, TurnTheDipoleToTheField) {
  const Disturbances dipole{.dipole_body_a_m2 = {0.5, 0.0, 0.0}};
  const Eigen::Quaterniond q_icrf_body = quaternion_by({0.0, 0.0, kQuarter_rad});
  const Vector3d torque_nm =
      disturbance_body_nm(dipole, kInertia_kg_m2, after(0.0), q_icrf_body, 0.0);
  EXPECT_LT((torque_nm - Vector3d{0.0, -0.5 * 30e-6, 0.0}).norm(), 1e-18);
}

TEST(Disturbances, AreConstantAndSwingWithTheOrbit) {
  const Disturbances both{
      .constant_body_nm = {5e-5, 0.0, 0.0},
      .periodic = {
          .amplitude_body_nm = {0.0, 1e-5, 0.0}, .rate_rad_s = kRate_rad_s, .phase_rad = 0.5}};
  const Vector3d torque_nm =
      disturbance_body_nm(both, kInertia_kg_m2, {}, quaternion_by({1.0, 0.0, 0.0}), 700.0);
  EXPECT_LT((torque_nm - Vector3d{5e-5, 1e-5 * std::sin(700.0 * kRate_rad_s + 0.5), 0.0}).norm(),
            1e-18);
}

}  // namespace spindrift::disturbances_test
