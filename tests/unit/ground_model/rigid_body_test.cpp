#include "pipelines/ground_model/dynamics/rigid_body.h"

#include <gtest/gtest.h>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/dynamics/body_motion.h"

namespace spindrift::rigid_body_test {

using Eigen::Vector3d;

const BodyState kStart{.q_icrf_body = Eigen::Quaterniond{0.3, -0.5, 0.7, 0.4}.normalized(),
                       .rate_body_rad_s = {0.011, -0.006, 0.009}};

Eigen::Matrix3d inertia_kg_m2() {
  Eigen::Matrix3d inertia;
  inertia << 120.0, 3.0, -5.0,  //
      3.0, 100.0, 7.0,          //
      -5.0, 7.0, 140.0;
  return inertia;
}

TEST(RigidBody, KeepsMomentumAndEnergyWithoutTorqueOverAnOrbit) {
  const RigidBody body{inertia_kg_m2()};
  const auto momentum = [](const BodyState& state) -> Vector3d {
    return state.q_icrf_body * Vector3d{inertia_kg_m2() * state.rate_body_rad_s};
  };
  const auto energy = [](const BodyState& state) {
    return state.rate_body_rad_s.dot(inertia_kg_m2() * state.rate_body_rad_s);
  };
  BodyState state = kStart;
  for (int i = 0; i < 5900 * 20; ++i) {
    state = body.after(state, Vector3d::Zero(), 0.05);
  }
  EXPECT_GT(angle_between_rad(state.q_icrf_body, kStart.q_icrf_body), 0.1);
  EXPECT_LT((momentum(state) - momentum(kStart)).norm(), 1e-9 * momentum(kStart).norm());
  EXPECT_NEAR(energy(state), energy(kStart), 1e-9 * energy(kStart));
}

TEST(RigidBody, GainsTheMomentumOfTheTorqueAboutAPrincipalAxis) {
  const RigidBody body{Vector3d{120.0, 100.0, 140.0}.asDiagonal()};
  BodyState state{.q_icrf_body = Eigen::Quaterniond::Identity(),
                  .rate_body_rad_s = {0.0, 0.002, 0.0}};
  for (int i = 0; i < 400; ++i) {
    state = body.after(state, {0.0, 0.07, 0.0}, 0.05);
  }
  EXPECT_NEAR(state.rate_body_rad_s.y(), 0.002 + 20.0 * 0.07 / 100.0, 1e-14);
  EXPECT_LT((rotation_vector_of(state.q_icrf_body) -
             Vector3d{0.0, 0.002 * 20.0 + 0.5 * 0.07 / 100.0 * 400.0, 0.0})
                .norm(),
            1e-12);
}

TEST(BodyMotion, IsBetweenItsStepsWhereTheBodyWouldBe) {
  const RigidBody body{inertia_kg_m2()};
  BodyMotion motion{body, kStart, 0.5};
  motion.step({0.1, 0.0, 0.0});
  motion.step({0.0, -0.2, 0.0});
  EXPECT_EQ(motion.end_s(), 1.0);
  EXPECT_EQ(motion.at(0.0).rate_body_rad_s, kStart.rate_body_rad_s);
  EXPECT_EQ(motion.at(1.0).rate_body_rad_s, motion.last().rate_body_rad_s);
  EXPECT_EQ(motion.at(1.3).rate_body_rad_s, motion.last().rate_body_rad_s);
  const BodyState middle = motion.at(0.7);
  const BodyState end = body.after(middle, {0.0, -0.2, 0.0}, 0.3);
  EXPECT_LT((end.rate_body_rad_s - motion.last().rate_body_rad_s).norm(), 1e-11);
  EXPECT_LT(angle_between_rad(end.q_icrf_body, motion.last().q_icrf_body), 1e-11);
}

}  // namespace spindrift::rigid_body_test
