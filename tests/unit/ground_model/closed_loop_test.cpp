// Figures of Li 2017 and Zhang 2019 that the ground model must reproduce.

#include "pipelines/ground_model/control/closed_loop.h"

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/control/attitude_control.h"
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_body.h"

namespace spindrift::closed_loop_test {

using Eigen::Vector3d;

constexpr double kStep_s = 0.025;
constexpr int kSteps = 4;  // 10 Hz.
constexpr double kFrequency_rad_s = 0.1;
constexpr double kDamping = 0.6716;
const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};
const Eigen::Quaterniond kTarget = Eigen::Quaterniond{0.7071, 0.7071, 0.0, 0.0}.normalized();
constexpr double kMostSpeed_rpm = 6000.0;
const double kRadPerSPerRpm = kTurn_rad / 60.0;

Wheels wheels() {
  const double speed_rad_s = kMostSpeed_rpm * kRadPerSPerRpm;
  return Wheels::make({.axes_body = Eigen::Matrix3d::Identity(),
                       .inertia_kg_m2 = 0.3 / speed_rad_s,
                       .torque_nm_most = 0.01,
                       .speed_rad_s_most = speed_rad_s})
      .value();
}

ClosedLoop<SteppedBody> loop_of(const Vector3d& moments_kg_m2, const Disturbances& disturbances) {
  return {SteppedBody{RigidBody::make(Eigen::Matrix3d{moments_kg_m2.asDiagonal()}).value(),
                      {.q_icrf_body = Eigen::Quaterniond::Identity(),
                       .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
                      kStep_s},
          wheels(), disturbances, kSteps};
}

const PdGains kGains = PdGains::of(kMoments_kg_m2, kFrequency_rad_s, kDamping);

SaturatedPd orientation() {
  constexpr double kSlew_rad_s = kRadPerDeg;
  return {.target = {.q_icrf_target = kTarget},
          .gains = kGains,
          .error_most = (kGains.kd_nms.cwiseQuotient(kGains.kp_nm)).x() * kSlew_rad_s};
}

/// Returns the sequence of 2 s without control, damping to 0.1 deg/s, and orientation.
AttitudeControl sequence(const PointingLaw& pointing) {
  return AttitudeControl::make(
             {.control_on_s = 2.0, .damped_rad_s = 0.1 * kRadPerDeg, .pointing_at_s = 100.0},
             RateFeedback{.gain_nms = kGains.kd_nms}, pointing)
      .value();
}

struct Flight {
  double settled_s = 0.0;   ///< Time since which it points within 1 deg.
  double pointing_s = 0.0;  ///< Time at which orientation began.
  double most_nms = 0.0;    ///< Largest momentum of a wheel.
  double most_rpm = 0.0;
  Vector3d last_off_rad = Vector3d::Zero();
};

double off_rad(const ClosedLoop<SteppedBody>& loop) {
  return angle_between_rad(loop.body().last().q_icrf_body, kTarget);
}

/// @param late Whether the torque acts one period late.
Flight flown(ClosedLoop<SteppedBody> loop, AttitudeControl control, bool late = false) {
  Flight flight;
  Vector3d asked_nm = Vector3d::Zero();
  while (loop.t_s() < 800.0) {
    const Vector3d now_nm = control.torque_body_nm(loop.t_s(), loop.measured(Vector3d::UnitX()));
    if (control.mode() != ControlMode::Pointing) {
      flight.pointing_s = loop.t_s() + loop.period_s();
    }
    loop.fly(late ? asked_nm : now_nm, {});
    asked_nm = now_nm;
    const Wheels& is = std::get<Wheels>(loop.actuators());
    flight.most_nms = std::max(flight.most_nms, is.momenta_nms().lpNorm<Eigen::Infinity>());
    flight.most_rpm =
        std::max(flight.most_rpm, is.speeds_rad_s().lpNorm<Eigen::Infinity>() / kRadPerSPerRpm);
    if (off_rad(loop) > kRadPerDeg) {
      flight.settled_s = loop.t_s();
    }
  }
  flight.last_off_rad = rotation_vector_of(kTarget.conjugate() * loop.body().last().q_icrf_body);
  return flight;
}

TEST(ClosedLoop, OrientsTheSatelliteOfSeed004) {
  const Flight flight = flown(loop_of(kMoments_kg_m2, {}), sequence(orientation()));
  EXPECT_LT(flight.settled_s, 240.0);
  EXPECT_LT(flight.most_nms, 0.11);
  EXPECT_LT(flight.most_rpm, 6000.0);
  EXPECT_LT(degrees(flight.last_off_rad.norm()), 1e-3);
  EXPECT_GT(flight.pointing_s, 20.0);
  EXPECT_LT(flight.pointing_s, 60.0);
}

TEST(ClosedLoop, HoldsItAgainstAConstantTorque) {
  constexpr double kTorque_nm = 5e-5;
  const Disturbances constant{.constant_body_nm = Vector3d::Constant(kTorque_nm)};
  const Flight flight = flown(loop_of(kMoments_kg_m2, constant), sequence(orientation()));
  EXPECT_LT(flight.settled_s, 240.0);
  EXPECT_LT(flight.most_nms, 0.17);
  EXPECT_LT(flight.most_rpm, 6000.0);
  // Without an integral term the torque is balanced by an error.
  const Vector3d expected_rad =
      kTorque_nm / (kFrequency_rad_s * kFrequency_rad_s) * kMoments_kg_m2.cwiseInverse();
  EXPECT_LT(degrees((flight.last_off_rad - expected_rad).norm()), 0.01);
}

TEST(ClosedLoop, HoldsItWithInertiaAFifthOffAndATorqueThatComesLate) {
  for (const double factor : {0.8, 1.0, 1.2}) {
    for (const bool late : {false, true}) {
      const Flight flight =
          flown(loop_of(factor * kMoments_kg_m2, {}), sequence(orientation()), late);
      EXPECT_LT(flight.settled_s, 240.0) << factor << late;
      EXPECT_LT(degrees(flight.last_off_rad.norm()), 0.01) << factor << late;
    }
  }
}

TEST(ClosedLoop, OrientsItByTheVariableLimit) {
  const VariableLimitPd law{.target = {.q_icrf_target = kTarget},
                            .gains = kGains,
                            .moments_kg_m2 = kMoments_kg_m2,
                            .torque_nm_most = 0.01,
                            .rate_rad_s_most = Vector3d::Constant(kRadPerDeg)};
  const Flight flight = flown(loop_of(kMoments_kg_m2, {}), sequence(law));
  EXPECT_LT(flight.settled_s, 240.0);
  EXPECT_LT(flight.most_nms, 0.11);
  EXPECT_LT(degrees(flight.last_off_rad.norm()), 1e-3);
}

TEST(ClosedLoop, KeepsTheMomentumOfBodyAndWheels) {
  ClosedLoop<SteppedBody> loop = loop_of(kMoments_kg_m2, {});
  AttitudeControl control = sequence(orientation());
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
    ClosedLoop<SteppedBody> loop = loop_of(kMoments_kg_m2, {});
    AttitudeControl control = sequence(orientation());
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
    EXPECT_LT(degrees(off_rad(loop)), 1e-2);
  }
}

/// In Li 2017 relays damp the rates before the satellite searches for the Sun.
TEST(ClosedLoop, DampsTheSatelliteOfSeed000In18SecondsAndHoldsMinusZAtTheSun) {
  const Eigen::Matrix3d inertia_kg_m2 = Vector3d{120.0, 100.0, 140.0}.asDiagonal();
  const ThrusterDesign thrusters{.torque_nm = 0.07, .shortest_s = 0.01, .longest_s = 1.0};
  ClosedLoop<SteppedBody> loop{
      SteppedBody{RigidBody::make(inertia_kg_m2).value(),
                  {.q_icrf_body = quaternion_by({2.0, -1.0, 0.5}),
                   .rate_body_rad_s = kRadPerDeg * Vector3d{0.618844, -0.33139, 0.065912}},
                  0.025},
      Thrusters::make(thrusters).value(),
      {},
      2};
  const double dead_band_rad_s = 0.03 * kRadPerDeg;
  AttitudeControl control =
      AttitudeControl::make(
          {.control_on_s = 0.0, .damped_rad_s = dead_band_rad_s, .pointing_at_s = 100.0},
          RelayDamping{.torque_nm = thrusters.torque_nm, .dead_band_rad_s = dead_band_rad_s},
          SunAcquisition{.inertia_kg_m2 = inertia_kg_m2,
                         .torque_nm_most = thrusters.torque_nm,
                         .slew_rad_s = 0.5 * kRadPerDeg,
                         .period_s = loop.period_s()})
          .value();
  double damped_s = 0.0;
  double most_off_deg = 0.0;
  while (loop.t_s() < 1200.0) {
    const MeasuredBody measured = loop.measured(Vector3d{0.6, -0.48, 0.64});
    loop.fly(control.torque_body_nm(loop.t_s(), measured), {});
    if (control.mode() != ControlMode::Pointing) {
      damped_s = loop.t_s();
    } else if (loop.t_s() > 600.0) {
      most_off_deg =
          std::max(most_off_deg, degrees(angle_between_rad(-Vector3d::UnitZ(), measured.sun_body)));
    }
  }
  EXPECT_NEAR(damped_s, 18.0, 0.5);
  EXPECT_LT(most_off_deg, 0.2);
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
