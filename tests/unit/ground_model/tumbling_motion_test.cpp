#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/reconstruction/torque_free_arc.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::tumbling_motion_test {

using Eigen::Vector3d;

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);
constexpr double kEnd_s = 900.0;

const Orbit kOrbit = testing::low_orbit(kStart);

TumblingTruth truth_at(const Vector3d& rate_deg_s) {
  return {.body = {.start = kStart,
                   .at_start = {.q_icrf_body = quaternion_by({2.0, -1.0, 0.5}),
                                .rate_body_rad_s = kRadPerDeg * rate_deg_s},
                   .inertia_kg_m2 = Vector3d{16.0, 18.0, 12.0}.asDiagonal(),
                   .end_s = kEnd_s}};
}

/// Returns a dipole field at the Earth's centre along its axis.
MainFieldModel dipole_field() {
  GaussCoefficients coefficients;
  coefficients.g_nt.at(GaussCoefficients::index(1, 0)) = -30'000.0;
  return MainFieldModel::make({{2020.0, coefficients}, {2030.0, coefficients}}).value();
}

double energy_j(const TumblingTruth& truth, const BodyState& body) {
  return 0.5 * body.rate_body_rad_s.dot(truth.body.inertia_kg_m2 * body.rate_body_rad_s);
}

Vector3d momentum_icrf_nms(const TumblingTruth& truth, const BodyState& body) {
  return body.q_icrf_body *
         (truth.body.inertia_kg_m2 * body.rate_body_rad_s + truth.wheels_body_nms);
}

TEST(TumblingMotion, IsFreeWhereNothingDisturbsIt) {
  const TumblingTruth truth = truth_at({1.2, -0.7, 0.9});
  const BodyMotion motion = tumbling_motion(truth, kOrbit).value();
  const BodyState expected =
      torque_free_arc(start_of_arc(truth.body.at_start), truth.body.inertia_kg_m2, kEnd_s).body;
  EXPECT_DOUBLE_EQ(motion.end_s(), kEnd_s);
  EXPECT_LT(angle_between_rad(motion.last().q_icrf_body, expected.q_icrf_body), 1e-8);
  EXPECT_LT((motion.last().rate_body_rad_s - expected.rate_body_rad_s).norm(), 1e-10);
}

TEST(TumblingMotion, KeepsTheMomentumOfBodyAndWheelsInSpace) {
  TumblingTruth truth = truth_at({1.2, -0.7, 0.9});
  truth.wheels_body_nms = {0.0, -0.4, 0.0};
  const BodyMotion motion = tumbling_motion(truth, kOrbit).value();
  const Vector3d at_first_nms = momentum_icrf_nms(truth, truth.body.at_start);
  EXPECT_LT((momentum_icrf_nms(truth, motion.last()) - at_first_nms).norm(),
            1e-9 * at_first_nms.norm());
  // Without the wheels the motion ends differently.
  truth.wheels_body_nms.setZero();
  EXPECT_GT(angle_between_rad(motion.last().q_icrf_body,
                              tumbling_motion(truth, kOrbit).value().last().q_icrf_body),
            0.1);
}

TEST(TumblingMotion, KeepsEnergyAndMomentumHoweverFastTheWheelsMakeItSwing) {
  for (const double wheels_nms : {0.4, 4.0, 20.0}) {
    TumblingTruth truth = truth_at({1.2, -0.7, 0.9});
    truth.wheels_body_nms = {0.0, -wheels_nms, 0.0};
    const BodyMotion motion = tumbling_motion(truth, kOrbit).value();
    const double at_first_j = energy_j(truth, truth.body.at_start);
    const Vector3d at_first_nms = momentum_icrf_nms(truth, truth.body.at_start);
    EXPECT_LT(std::abs(energy_j(truth, motion.last()) - at_first_j), 1e-9 * at_first_j)
        << wheels_nms;
    EXPECT_LT((momentum_icrf_nms(truth, motion.last()) - at_first_nms).norm(),
              1e-9 * at_first_nms.norm())
        << wheels_nms;
  }
  TumblingTruth truth = truth_at({1.2, -0.7, 0.9});
  truth.wheels_body_nms = {0.0, -100.0, 0.0};
  EXPECT_THAT(tumbling_motion(truth, kOrbit).error().message, HasSubstr("too coarse"));
}

TEST(TumblingMotion, GainsTheMomentumThatTheSurroundingsGive) {
  // The body is at rest, so that a constant torque in body axes is constant in space.
  constexpr double kTorque_nm = 1e-5;
  TumblingTruth truth = truth_at(Vector3d::Zero());
  truth.body.disturbances.constant_body_nm = {0.0, 0.0, kTorque_nm};
  const BodyMotion motion = tumbling_motion(truth, kOrbit).value();
  const double momentum_nms = 12.0 * motion.last().rate_body_rad_s.z();
  EXPECT_NEAR(momentum_nms, kTorque_nm * kEnd_s, 1e-9 * momentum_nms);
}

TEST(TumblingMotion, FeelsTheFieldByItsDipoleOnly) {
  TumblingTruth truth = truth_at({0.1, -0.1, 0.05});
  const Eigen::Quaterniond free = tumbling_motion(truth, kOrbit).value().last().q_icrf_body;
  truth.body.field = dipole_field();
  EXPECT_EQ(tumbling_motion(truth, kOrbit).value().last().q_icrf_body.coeffs(), free.coeffs());
  truth.body.disturbances.dipole_body_a_m2 = {0.0, 0.0, 1.0};
  const BodyMotion turned = tumbling_motion(truth, kOrbit).value();
  EXPECT_GT(angle_between_rad(turned.last().q_icrf_body, free), 0.01);
  // The torque is about 2e-5 T on 1 A m2, perpendicular to the dipole.
  const Vector3d gained_nms =
      momentum_icrf_nms(truth, turned.last()) - momentum_icrf_nms(truth, truth.body.at_start);
  EXPECT_LT(gained_nms.norm(), 5e-5 * kEnd_s);
}

TEST(TumblingMotion, IsRefusedWhereTheFieldDoesNotReach) {
  TumblingTruth truth = truth_at({0.1, -0.1, 0.05});
  truth.body.disturbances.dipole_body_a_m2 = {0.0, 0.0, 1.0};
  GaussCoefficients coefficients;
  truth.body.field = MainFieldModel::make({{1900.0, coefficients}, {1910.0, coefficients}}).value();
  EXPECT_EQ(tumbling_motion(truth, kOrbit).error().code, ErrorCode::NoCoverage);
}

TEST(TumblingMotion, SaysWhenTheSurroundingsMakeItTurnTooFast) {
  TumblingTruth truth = truth_at({0.0, 0.0, 0.1});
  truth.body.disturbances.constant_body_nm = {0.0, 0.0, 0.1};
  EXPECT_THAT(tumbling_motion(truth, kOrbit).error().message,
              HasSubstr("too coarse for a body that turns by"));
  truth.body.inertia_kg_m2(0, 0) = 100.0;
  EXPECT_THAT(tumbling_motion(truth, kOrbit).error().message,
              HasSubstr("not above the sum of the others"));
}

}  // namespace spindrift::tumbling_motion_test
