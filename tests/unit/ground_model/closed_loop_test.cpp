#include "pipelines/ground_model/control/closed_loop.h"

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_body.h"

namespace spindrift::closed_loop_test {

using Eigen::Vector3d;

constexpr double kStep_s = 0.025;
constexpr int kSteps = 4;  // 10 Hz.
const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};
const Eigen::Quaterniond kTarget = Eigen::Quaterniond{0.7071, 0.7071, 0.0, 0.0}.normalized();

Wheels wheels() {
  const double speed_rad_s = 6000.0 / 60.0 * kTurn_rad;
  return Wheels::make({.axes_body = Eigen::Matrix3d::Identity(),
                       .inertia_kg_m2 = 0.3 / speed_rad_s,
                       .torque_nm_most = 0.01,
                       .speed_rad_s_most = speed_rad_s})
      .value();
}

/// Returns the satellite of Zhang 2019 at separation.
ClosedLoop<SteppedBody> loop_at_start() {
  return {SteppedBody{RigidBody::make(Eigen::Matrix3d{kMoments_kg_m2.asDiagonal()}).value(),
                      {.q_icrf_body = Eigen::Quaterniond::Identity(),
                       .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
                      kStep_s},
          wheels(),
          {},
          kSteps};
}

const PdGains kGains = PdGains::of(kMoments_kg_m2, 0.1, 0.6716);

SaturatedPd orientation() {
  constexpr double kSlew_rad_s = kRadPerDeg;
  return {.target = {.q_icrf_target = kTarget},
          .gains = kGains,
          .error_most = (kGains.kd_nms.cwiseQuotient(kGains.kp_nm)).x() * kSlew_rad_s};
}

/// Returns the sequence of 2 s without control, damping to 0.1 deg/s, and orientation.
AttitudeControl sequence() {
  return AttitudeControl::make(
             {.control_on_s = 2.0, .damped_rad_s = 0.1 * kRadPerDeg, .pointing_at_s = 100.0},
             RateFeedback{.gain_nms = kGains.kd_nms}, orientation())
      .value();
}

TEST(ClosedLoop, KeepsTheMomentumOfBodyAndWheels) {
  ClosedLoop<SteppedBody> loop = loop_at_start();
  AttitudeControl control = sequence();
  const auto momentum_icrf_nms = [&]() -> Vector3d {
    return loop.body().last().q_icrf_body * loop.measured(Vector3d::UnitX()).momentum_body_nms;
  };
  const Vector3d at_first_nms = momentum_icrf_nms();
  while (loop.t_s() < 800.0) {
    loop.fly(control.torque_body_nm(loop.t_s(), loop.measured(Vector3d::UnitX())), {});
  }
  EXPECT_LT((momentum_icrf_nms() - at_first_nms).norm(), 1e-10 * at_first_nms.norm());
}

/// In Zhang 2019 the computer knows the attitude from its gyro alone.
TEST(ClosedLoop, OrientsItByAnAttitudeOfTheGyroAlone) {
  for (const GyroPropagation by : {GyroPropagation::Composition, GyroPropagation::RungeKutta}) {
    ClosedLoop<SteppedBody> loop = loop_at_start();
    AttitudeControl control = sequence();
    MeasuredBody measured = loop.measured(Vector3d::UnitX());
    while (loop.t_s() < 800.0) {
      const MeasuredBody before = measured;
      loop.fly(control.torque_body_nm(loop.t_s(), measured), {});
      measured = loop.measured(Vector3d::UnitX());
      measured.q_icrf_body = propagated(by, before.q_icrf_body,
                                        {.dt_s = loop.period_s(),
                                         .from_rad_s = before.rate_body_rad_s,
                                         .to_rad_s = measured.rate_body_rad_s});
    }
    EXPECT_LT(degrees(angle_between_rad(measured.q_icrf_body, kTarget)), 1e-3);
    EXPECT_LT(degrees(angle_between_rad(loop.body().last().q_icrf_body, kTarget)), 1e-2);
  }
}

TEST(AttitudeControl, RefusesTimesThatCannotBe) {
  const auto with = [](const ControlPlan& plan) {
    return AttitudeControl::make(plan, RateFeedback{kGains.kd_nms}, orientation());
  };
  EXPECT_THAT(
      with({.control_on_s = -2.0, .damped_rad_s = 0.0, .pointing_at_s = 3.0}).error().message,
      HasSubstr("control is on at -2 s"));
  EXPECT_FALSE(with({.control_on_s = 4.0, .damped_rad_s = 0.0, .pointing_at_s = 3.0}));
  EXPECT_FALSE(with({.control_on_s = 2.0, .damped_rad_s = -0.1, .pointing_at_s = 3.0}));
}

TEST(AttitudeControl, PointsAtTheLatestWhenDampingHasHadItsTime) {
  AttitudeControl control =
      AttitudeControl::make({.control_on_s = 2.0, .damped_rad_s = 0.0, .pointing_at_s = 3.0},
                            RateFeedback{kGains.kd_nms}, orientation())
          .value();
  const MeasuredBody still{.q_icrf_body = kTarget,
                           .rate_body_rad_s = Vector3d::Zero(),
                           .momentum_body_nms = Vector3d::Zero(),
                           .sun_body = Vector3d::UnitX()};
  for (const auto& [t_s, mode] : {std::pair{1.9, ControlMode::Drift},
                                  {2.0, ControlMode::Damping},
                                  {2.9, ControlMode::Damping},
                                  {3.0, ControlMode::Pointing}}) {
    control.torque_body_nm(t_s, still);
    EXPECT_EQ(control.mode(), mode) << t_s;
  }
}

}  // namespace spindrift::closed_loop_test
