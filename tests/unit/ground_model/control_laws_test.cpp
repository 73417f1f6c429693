#include "pipelines/ground_model/control/control_laws.h"

#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/control/saturation.h"
#include "tests/support/matchers.h"

namespace spindrift::control_laws_test {

using Eigen::Vector3d;

const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};
const PdGains kGains = PdGains::of(kMoments_kg_m2, 0.1, 0.6716);

MeasuredBody off_by(const Vector3d& turn_rad, const Vector3d& rate_rad_s) {
  return {.q_icrf_body = quaternion_by(turn_rad),
          .rate_body_rad_s = rate_rad_s,
          .momentum_body_nms = kMoments_kg_m2.cwiseProduct(rate_rad_s),
          .sun_body = -Vector3d::UnitZ()};
}

AttitudeTarget at_rest() { return {.q_icrf_target = Eigen::Quaterniond::Identity()}; }

TEST(Saturation, KeepsTheDirection) {
  EXPECT_EQ(within_largest(Vector3d{0.1, -0.4, 0.2}, 0.5), Vector3d(0.1, -0.4, 0.2));
  EXPECT_LT((within_largest(Vector3d{0.1, -0.4, 0.2}, 0.2) - Vector3d{0.05, -0.2, 0.1}).norm(),
            1e-15);
  EXPECT_LT((within_length({3.0, 0.0, -4.0}, 1.0) - Vector3d{0.6, 0.0, -0.8}).norm(), 1e-15);
  EXPECT_EQ(within_length(Vector3d::Zero(), 1.0), Vector3d::Zero());
}

TEST(RateFeedback, IsAgainstTheRate) {
  const RateFeedback law{.gain_nms = {1.0, 2.0, 3.0}};
  EXPECT_EQ(law.torque_body_nm(off_by(Vector3d::Zero(), {0.1, -0.1, 0.2})),
            Vector3d(-0.1, 0.2, -0.6000000000000001));
}

TEST(RelayDamping, LeavesTheDeadBandAlone) {
  const RelayDamping law{.torque_nm = 0.07, .dead_band_rad_s = 0.01};
  EXPECT_EQ(law.torque_body_nm(off_by(Vector3d::Zero(), {0.1, -0.02, 0.01})),
            Vector3d(-0.07, 0.07, 0.0));
}

TEST(SaturatedPd, IsOfSecondOrderNearTheTarget) {
  const SaturatedPd law{.target = at_rest(), .gains = kGains, .error_most = 0.1};
  const Vector3d turn_rad{0.01, -0.02, 0.005};
  const Vector3d torque_nm = law.torque_body_nm(off_by(turn_rad, Vector3d::Zero()));
  EXPECT_LT((torque_nm + 0.01 * kMoments_kg_m2.cwiseProduct(turn_rad)).norm(), 1e-7);
}

TEST(SaturatedPd, TurnsTheShortWayAndKeepsTheDirectionOfALargeError) {
  const SaturatedPd law{.target = at_rest(), .gains = kGains, .error_most = 0.1};
  MeasuredBody far = off_by({3.0, 0.6, 0.0}, Vector3d::Zero());
  const Vector3d torque_nm = law.torque_body_nm(far);
  EXPECT_LT((torque_nm.cwiseQuotient(kGains.kp_nm) - Vector3d{-0.1, -0.02, 0.0}).norm(), 1e-12);
  far.q_icrf_body.coeffs() *= -1.0;
  EXPECT_LT((law.torque_body_nm(far) - torque_nm).norm(), 1e-15);
}

TEST(SaturatedPd, AddsWhatTheTurningMomentumTakes) {
  const SaturatedPd law{
      .target = at_rest(), .gains = {Vector3d::Zero(), Vector3d::Zero()}, .error_most = 0.1};
  MeasuredBody turning = off_by(Vector3d::Zero(), {0.01, 0.02, 0.0});
  turning.momentum_body_nms = {0.0, 0.0, 0.5};
  EXPECT_LT((law.torque_body_nm(turning) - Vector3d{0.01, -0.005, 0.0}).norm(), 1e-15);
}

TEST(SaturatedPd, FollowsATargetThatTurns) {
  const Vector3d rate_rad_s{0.0, 0.001, 0.0};
  const SaturatedPd law{
      .target = {.q_icrf_target = quaternion_by({0.5, 0.0, 0.0}), .rate_target_rad_s = rate_rad_s},
      .gains = kGains,
      .error_most = 0.1};
  const MeasuredBody with = {.q_icrf_body = quaternion_by({0.5, 0.0, 0.0}),
                             .rate_body_rad_s = rate_rad_s,
                             .momentum_body_nms = Vector3d::Zero(),
                             .sun_body = Vector3d::UnitX()};
  EXPECT_LT(law.torque_body_nm(with).norm(), 1e-15);
}

// Full torque a stops the body within the angle at rate^2 = 2 a angle, where the sine of the half
// angle stands for the angle.
TEST(VariableLimitPd, AsksForNoTorqueWhereTheAxisCanJustBeStopped) {
  const double angle_rad = 1.0;
  const double torque_nm = 1e-4;
  const VariableLimitPd law{.target = at_rest(),
                            .gains = kGains,
                            .moments_kg_m2 = kMoments_kg_m2,
                            .torque_nm_most = torque_nm,
                            .rate_rad_s_most = Vector3d::Constant(1.0)};
  const double rate_rad_s = std::sqrt(4.0 * torque_nm / 0.6 * std::sin(0.5 * angle_rad));
  EXPECT_NEAR(rate_rad_s / std::sqrt(2.0 * torque_nm / 0.6 * angle_rad), 1.0, 0.03);
  EXPECT_LT(law.torque_body_nm(off_by({angle_rad, 0.0, 0.0}, {-rate_rad_s, 0.0, 0.0})).norm(),
            1e-12);
  EXPECT_NEAR(law.torque_body_nm(off_by({angle_rad, 0.0, 0.0}, Vector3d::Zero())).norm(), torque_nm,
              1e-12);
}

TEST(VariableLimitPd, TurnsNoFasterThanItMay) {
  const VariableLimitPd law{.target = at_rest(),
                            .gains = kGains,
                            .moments_kg_m2 = kMoments_kg_m2,
                            .torque_nm_most = 1.0,
                            .rate_rad_s_most = Vector3d::Constant(0.02)};
  EXPECT_LT(law.torque_body_nm(off_by({0.0, 2.0, 0.0}, {0.0, -0.02, 0.0})).norm(), 1e-12);
}

TEST(SunAcquisition, AsksForTheRateThatTurnsMinusZToTheSun) {
  const SunAcquisition law{.inertia_kg_m2 = Vector3d{120.0, 100.0, 140.0}.asDiagonal(),
                           .torque_nm_most = 0.07,
                           .slew_rad_s = 0.01,
                           .period_s = 0.05};
  MeasuredBody measured = off_by(Vector3d::Zero(), Vector3d::Zero());
  EXPECT_EQ(law.torque_body_nm(measured), Vector3d::Zero());
  measured.sun_body = {0.0, 1.0, 0.0};
  EXPECT_LT((law.torque_body_nm(measured) * 0.05 - Vector3d{120.0 * 0.01, 0.0, 0.0}).norm(), 1e-12);
  measured.sun_body = quaternion_by({0.001, 0.0, 0.0}) * -Vector3d::UnitZ();
  EXPECT_NEAR(law.torque_body_nm(measured).x() * 0.05, 120.0 * 1e-4, 1e-6);
  measured.sun_body = Vector3d::UnitZ();
  EXPECT_NEAR((law.torque_body_nm(measured) * 0.05).norm(), 120.0 * 0.01, 1e-9);
}

}  // namespace spindrift::control_laws_test
