#include "pipelines/ground_model/dynamics/rigid_body.h"

#include <complex>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_body.h"

namespace spindrift::rigid_body_test {

using Eigen::Vector3d;

const BodyState kStart{.q_icrf_body = Eigen::Quaterniond{0.3, -0.5, 0.7, 0.4}.normalized(),
                       .rate_body_rad_s = {0.011, -0.006, 0.009}};

RigidBody body_of(const Eigen::Matrix3d& inertia_kg_m2) {
  return RigidBody::make(inertia_kg_m2).value();
}

RigidBody body_of(const Vector3d& moments_kg_m2) {
  return body_of(Eigen::Matrix3d{moments_kg_m2.asDiagonal()});
}

Eigen::Matrix3d inertia_kg_m2() {
  Eigen::Matrix3d inertia;
  inertia << 120.0, 3.0, -5.0,  //
      3.0, 100.0, 7.0,          //
      -5.0, 7.0, 140.0;
  return inertia;
}

Vector3d momentum_icrf_nms(const SteppedBody& body, const Vector3d& wheels_nms) {
  const Vector3d momentum_body_nms =
      body.body().inertia_kg_m2() * body.last().rate_body_rad_s + wheels_nms;
  return body.last().q_icrf_body * momentum_body_nms;
}

double energy(const SteppedBody& body) {
  const Vector3d& rate_rad_s = body.last().rate_body_rad_s;
  return rate_rad_s.dot(body.body().inertia_kg_m2() * rate_rad_s);
}

// At 5.2 deg/s the body rotates by 0.26 deg in a step and 85 times in the orbit.
TEST(RigidBody, KeepsMomentumAndEnergyWithoutTorqueOverAnOrbit) {
  SteppedBody body{
      body_of(Vector3d{0.6, 1.2, 1.12}),
      {.q_icrf_body = kStart.q_icrf_body, .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
      0.05};
  const Vector3d momentum_nms = momentum_icrf_nms(body, Vector3d::Zero());
  const double energy_at_first = energy(body);
  for (int i = 0; i < 5900 * 20; ++i) {
    body.step({});
  }
  EXPECT_LT((momentum_icrf_nms(body, Vector3d::Zero()) - momentum_nms).norm(),
            1e-9 * momentum_nms.norm());
  EXPECT_NEAR(energy(body), energy_at_first, 1e-9 * energy_at_first);
}

TEST(RigidBody, NutatesAsASymmetricBodyDoes) {
  constexpr double kAcross_kg_m2 = 100.0;
  constexpr double kAlong_kg_m2 = 130.0;
  constexpr double kSpin_rad_s = 0.5;
  constexpr double kStep_s = 0.05;
  constexpr int kSteps = 20'000;
  SteppedBody body{body_of(Vector3d{kAcross_kg_m2, kAcross_kg_m2, kAlong_kg_m2}),
                   {.q_icrf_body = kStart.q_icrf_body, .rate_body_rad_s = {0.1, 0.0, kSpin_rad_s}},
                   kStep_s};
  double nutated_rad = 0.0;
  std::complex<double> before{0.1, 0.0};
  for (int i = 0; i < kSteps; ++i) {
    body.step({});
    const Vector3d& rate_rad_s = body.last().rate_body_rad_s;
    const std::complex<double> across{rate_rad_s.x(), rate_rad_s.y()};
    nutated_rad += std::arg(across / before);
    before = across;
  }
  const double expected_rad_s = (kAlong_kg_m2 - kAcross_kg_m2) / kAcross_kg_m2 * kSpin_rad_s;
  EXPECT_NEAR(nutated_rad / (kSteps * kStep_s) / expected_rad_s, 1.0, 1e-6);
}

TEST(RigidBody, GainsTheMomentumOfTheTorqueAboutAPrincipalAxis) {
  SteppedBody body{
      body_of(Vector3d{120.0, 100.0, 140.0}),
      {.q_icrf_body = Eigen::Quaterniond::Identity(), .rate_body_rad_s = {0.0, 0.002, 0.0}},
      0.05};
  for (int i = 0; i < 400; ++i) {
    body.step({.external_nm = {0.0, 0.07, 0.0}});
  }
  EXPECT_NEAR(body.last().rate_body_rad_s.y(), 0.002 + 20.0 * 0.07 / 100.0, 1e-14);
  EXPECT_LT((rotation_vector_of(body.last().q_icrf_body) -
             Vector3d{0.0, 0.002 * 20.0 + 0.5 * 0.07 / 100.0 * 400.0, 0.0})
                .norm(),
            1e-12);
}

TEST(RigidBody, KeepsTheMomentumOfBodyAndWheelsWhateverTheWheelsDo) {
  constexpr double kStep_s = 0.05;
  SteppedBody body{body_of(inertia_kg_m2()), kStart, kStep_s};
  Vector3d wheels_nms{0.5, -1.0, 0.2};
  const Vector3d momentum_nms = momentum_icrf_nms(body, wheels_nms);
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d torque_nm =
        0.01 * Vector3d{std::sin(1e-3 * i), std::cos(3e-3 * i), std::sin(2e-3 * i)};
    body.step({.wheels_nm = torque_nm, .wheels_nms = wheels_nms});
    wheels_nms -= kStep_s * torque_nm;
  }
  EXPECT_GT((wheels_nms - Vector3d{0.5, -1.0, 0.2}).norm(), 0.1);
  EXPECT_LT((momentum_icrf_nms(body, wheels_nms) - momentum_nms).norm(),
            1e-10 * momentum_nms.norm());
}

TEST(RigidBody, ConvergesInFourthOrder) {
  const auto after_100_s = [](int steps) {
    SteppedBody body{
        body_of(inertia_kg_m2()),
        {.q_icrf_body = kStart.q_icrf_body, .rate_body_rad_s = 10.0 * kStart.rate_body_rad_s},
        100.0 / steps};
    for (int i = 0; i < steps; ++i) {
      body.step({});
    }
    return body.last().q_icrf_body;
  };
  const Eigen::Quaterniond exact = after_100_s(10'000);
  const double coarse_rad = angle_between_rad(after_100_s(100), exact);
  const double fine_rad = angle_between_rad(after_100_s(200), exact);
  EXPECT_NEAR(std::log2(coarse_rad / fine_rad), 4.0, 0.2);
}

TEST(RigidBody, RefusesWhatNoBodyCanHave) {
  Eigen::Matrix3d lopsided = inertia_kg_m2();
  lopsided(0, 1) = 4.0;
  EXPECT_FALSE(RigidBody::make(lopsided));
  EXPECT_FALSE(RigidBody::make(Eigen::Matrix3d{Vector3d{1.0, -1.0, 1.0}.asDiagonal()}));
  EXPECT_THAT(RigidBody::make(Eigen::Matrix3d{Vector3d{1.0, 1.0, 2.1}.asDiagonal()}),
              IsRefused(ErrorCode::InvalidConfiguration, HasSubstr("1, 1 and 2.1 kg m2")));
  EXPECT_TRUE(RigidBody::make(Eigen::Matrix3d{Vector3d{1.0, 1.0, 2.0}.asDiagonal()}));
}

TEST(BodyMotion, IsBetweenItsStepsWhereTheBodyWouldBe) {
  BodyMotion motion{body_of(inertia_kg_m2()), kStart, 0.2};
  motion.step({.external_nm = {0.1, 0.0, 0.0}});
  motion.step({.external_nm = {0.0, -0.2, 0.0},
               .wheels_nm = {0.0, 0.0, 0.1},
               .wheels_nms = {0.0, 0.0, 0.3}});
  EXPECT_EQ(motion.end_s(), 0.4);
  EXPECT_EQ(motion.at(0.0).rate_body_rad_s, kStart.rate_body_rad_s);
  EXPECT_EQ(motion.at(0.4).rate_body_rad_s, motion.last().rate_body_rad_s);
  EXPECT_EQ(motion.at(0.7).rate_body_rad_s, motion.last().rate_body_rad_s);
  const BodyState middle = motion.at(0.28);
  const BodyState end = motion.body().after(middle,
                                            {.external_nm = {0.0, -0.2, 0.0},
                                             .wheels_nm = {0.0, 0.0, 0.1},
                                             .wheels_nms = {0.0, 0.0, 0.3 - 0.08 * 0.1}},
                                            0.12);
  EXPECT_LT((end.rate_body_rad_s - motion.last().rate_body_rad_s).norm(), 1e-11);
  EXPECT_LT(angle_between_rad(end.q_icrf_body, motion.last().q_icrf_body), 1e-11);
}

TEST(BodyMotion, BeginsBeforeItsStart) {
  BodyMotion motion{body_of(inertia_kg_m2()), kStart, 0.5};
  motion.step({});
  const BodyState back = motion.body().after(motion.at(-0.2), {}, 0.2);
  EXPECT_LT(angle_between_rad(back.q_icrf_body, kStart.q_icrf_body), 1e-11);
}

}  // namespace spindrift::rigid_body_test
