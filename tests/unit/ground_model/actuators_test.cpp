#include "pipelines/ground_model/control/actuators.h"

#include "tests/support/matchers.h"

namespace spindrift::actuators_test {

using Eigen::Vector3d;

/// Source: Zhang 2019, 0.3 N m s at 6000 rpm.
WheelDesign design() {
  return {.axes_body = Eigen::Matrix3d::Identity(),
          .inertia_kg_m2 = 0.3 / 628.3185307,
          .torque_nm_most = 0.01,
          .speed_rad_s_most = 628.3185307};
}

WheelDesign pyramid() {
  WheelDesign four = design();
  four.axes_body.resize(3, 4);
  four.axes_body << 1.0, 0.0, -1.0, 0.0,  //
      0.0, 1.0, 0.0, -1.0,                //
      1.0, 1.0, 1.0, 1.0;
  return four;
}

TEST(Wheels, GiveTheTorqueAndTakeTheMomentum) {
  Wheels wheels = Wheels::make(design()).value();
  wheels.command({0.002, -0.004, 0.0}, 0.1);
  BodyTorques torques = wheels.step(0.05);
  EXPECT_LT((torques.wheels_nm - Vector3d{0.002, -0.004, 0.0}).norm(), 1e-16);
  EXPECT_EQ(torques.wheels_nms, Vector3d::Zero());
  torques = wheels.step(0.05);
  EXPECT_LT((torques.wheels_nms - Vector3d{-1e-4, 2e-4, 0.0}).norm(), 1e-16);
  EXPECT_LT((wheels.momentum_body_nms() - Vector3d{-2e-4, 4e-4, 0.0}).norm(), 1e-16);
  EXPECT_LT((wheels.speeds_rad_s() - wheels.told_rad_s()).norm(), 1e-12);
}

TEST(Wheels, ShareTheTorqueOutInAPyramid) {
  Wheels wheels = Wheels::make(pyramid()).value();
  for (const Vector3d& torque_nm :
       {Vector3d{0.001, 0.002, -0.003}, Vector3d{0.0, 0.0, 0.004}, Vector3d{0.003, 0.0, 0.0}}) {
    wheels.command(torque_nm, 0.1);
    EXPECT_LT((wheels.step(0.1).wheels_nm - torque_nm).norm(), 1e-15);
  }
}

TEST(Wheels, MakeATorqueThatIsTooLargeSmallerAlongItsDirection) {
  Wheels wheels = Wheels::make(pyramid()).value();
  const Vector3d wanted_nm{0.3, 0.2, -0.1};
  wheels.command(wanted_nm, 0.1);
  const Vector3d given_nm = wheels.step(0.1).wheels_nm;
  EXPECT_LT(given_nm.normalized().cross(wanted_nm.normalized()).norm(), 1e-14);
  EXPECT_NEAR(wheels.momenta_nms().lpNorm<Eigen::Infinity>(), 0.01 * 0.1, 1e-15);
}

TEST(Wheels, TurnNoFasterThanTheyCan) {
  Wheels wheels = Wheels::make(design()).value();
  for (int i = 0; i < 400; ++i) {
    wheels.command({0.01, 0.0, 0.0}, 0.1);
    wheels.step(0.1);
  }
  EXPECT_NEAR(wheels.speeds_rad_s()[0], -628.3185307, 1e-9);
  wheels.command({0.01, 0.001, 0.0}, 0.1);
  EXPECT_LT((wheels.step(0.1).wheels_nm - Vector3d{0.0, 0.001, 0.0}).norm(), 1e-12);
}

TEST(Wheels, AreRefusedWhereTheyDoNotSpanSpace) {
  WheelDesign flat = design();
  flat.axes_body.col(2) = Vector3d{1.0, 1.0, 0.0};
  EXPECT_THAT(Wheels::make(flat).error().message, HasSubstr("3 wheels do not span space"));
  WheelDesign two = design();
  two.axes_body = WheelAxes{Eigen::Matrix3d::Identity().leftCols<2>()};
  EXPECT_EQ(Wheels::make(two).error().code, ErrorCode::InvalidConfiguration);
  WheelDesign none = design();
  none.axes_body.col(1).setZero();
  EXPECT_THAT(Wheels::make(none).error().message, HasSubstr("the shortest axis 0 long"));
  none.axes_body.resize(3, 0);
  EXPECT_THAT(Wheels::make(none).error().message, HasSubstr("0 wheels"));
  WheelDesign weak = design();
  weak.torque_nm_most = 0.0;
  EXPECT_THAT(Wheels::make(weak).error().message, HasSubstr("must be above 0"));
}

TEST(Thrusters, PulseAsLongAsTheImpulseAskedFor) {
  Thrusters thrusters =
      Thrusters::make({.torque_nm = 0.07, .shortest_s = 0.02, .longest_s = 1.0}).value();
  thrusters.command({0.07 * 0.5, -0.07 * 0.01, -0.14}, 2.0);
  Vector3d impulse_nms = Vector3d::Zero();
  for (int i = 0; i < 40; ++i) {
    const Vector3d torque_nm = thrusters.step(0.05).external_nm;
    EXPECT_LE(torque_nm.cwiseAbs().maxCoeff(), 0.07 + 1e-15);
    impulse_nms += 0.05 * torque_nm;
  }
  // The second axis asks for less than the shortest pulse, the third for more than the longest.
  EXPECT_LT((impulse_nms - 0.07 * Vector3d{1.0, -0.02, -1.0}).norm(), 1e-14);
}

TEST(Thrusters, StayOffWhereThePulseWouldBeTooShort) {
  Thrusters thrusters =
      Thrusters::make({.torque_nm = 0.07, .shortest_s = 0.02, .longest_s = 1.0}).value();
  thrusters.command({0.07 * 0.0199, 0.0, -0.07 * 0.0201}, 1.0);
  const Vector3d torque_nm = thrusters.step(0.1).external_nm;
  EXPECT_EQ(torque_nm.head<2>(), Eigen::Vector2d::Zero());
  EXPECT_NEAR(torque_nm.z(), -0.07 * 0.201, 1e-15);
}

TEST(Thrusters, AreRefusedWithPulsesOutOfOrder) {
  EXPECT_THAT(
      Thrusters::make({.torque_nm = 0.07, .shortest_s = 0.1, .longest_s = 0.05}).error().message,
      HasSubstr("pulses from 0.1 to 0.05 s"));
  EXPECT_FALSE(Thrusters::make({.torque_nm = -0.07, .shortest_s = 0.1, .longest_s = 1.0}));
  EXPECT_FALSE(Thrusters::make({.torque_nm = 0.07, .shortest_s = -0.1, .longest_s = 1.0}));
}

}  // namespace spindrift::actuators_test
