// Figures of Zhang 2019 that a flight of its sequence must reproduce.

#include "pipelines/ground_model/flights/orientation_motion.h"

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::orientation_motion_test {

using Eigen::Vector3d;

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);
const Vector3d kMoments_kg_m2{0.6, 1.2, 1.12};
const double kMostSpeed_rad_s = 6000.0 / 60.0 * kTurn_rad;

const Orbit kOrbit = testing::low_orbit(kStart);

OrientationTruth truth() {
  return {
      .body = {.start = kStart,
               .at_start = {.q_icrf_body = quaternion_by({2.0, -1.0, 0.5}),
                            .rate_body_rad_s = kRadPerDeg * Vector3d{3.0, -3.0, 3.0}},
               .inertia_kg_m2 = kMoments_kg_m2.asDiagonal(),
               .end_s = 800.0},
      .control = {
          .plan = {.control_on_s = 2.0, .damped_rad_s = 0.1 * kRadPerDeg, .pointing_at_s = 100.0},
          .q_start_target = Eigen::Quaterniond{0.7071, 0.7071, 0.0, 0.0}.normalized(),
          .wheels = {.axes_body = Eigen::Matrix3d::Identity(),
                     .inertia_kg_m2 = 0.3 / kMostSpeed_rad_s,
                     .torque_nm_most = 0.01,
                     .speed_rad_s_most = kMostSpeed_rad_s},
          .moments_kg_m2 = kMoments_kg_m2,
          .frequency_rad_s = 0.1,
          .damping = 0.6716,
          .slew_rad_s = kRadPerDeg,
          .variable_limit = false,
          .period_s = 0.1,
          .periods_late = 0,
          .by_gyro = GyroPropagation::RungeKutta}};
}

TrueGyro gyro_with(const Vector3d& bias_deg_s, double noise_deg_s = 0.0) {
  return {.sampling = {0.0, 0.1},
          .noise_rad_s = noise_deg_s * kRadPerDeg,
          .bias_rad_s = bias_deg_s * kRadPerDeg,
          .range_rad_s = std::nullopt};
}

Orientation flown(const OrientationTruth& truth, const TrueGyro& gyro) {
  Chance chance{3};
  return orientation_motion(truth, gyro, kOrbit, chance).value();
}

/// Holds how the computer knows its attitude and the largest error of pointing with it.
struct Knowledge {
  std::optional<GyroPropagation> by_gyro;  ///< Empty: it knows the true one.
  double limit_deg;
};
constexpr Knowledge kKnowledge[] = {{std::nullopt, 1e-3},
                                    {GyroPropagation::Composition, 0.01},
                                    {GyroPropagation::RungeKutta, 0.01}};

std::string refusal_of(const OrientationTruth& truth) {
  Chance chance{3};
  return orientation_motion(truth, gyro_with(Vector3d::Zero()), kOrbit, chance).error().message;
}

TEST(OrientationMotion, PointsTheSatelliteOfSeed004ByEitherLawAndEitherAttitude) {
  for (const bool variable_limit : {false, true}) {
    for (const auto& [by_gyro, limit_deg] : kKnowledge) {
      SCOPED_TRACE(::testing::Message() << variable_limit << ", limit " << limit_deg);
      OrientationTruth undisturbed = truth();
      undisturbed.control.variable_limit = variable_limit;
      undisturbed.control.by_gyro = by_gyro;
      const Orientation flight = flown(undisturbed, gyro_with(Vector3d::Zero()));
      const OrientationOutcome outcome = outcome_of(flight, undisturbed);
      EXPECT_EQ(flight.record.size(), 8001U);
      EXPECT_DOUBLE_EQ(flight.motion.end_s(), 800.0);
      EXPECT_GT(*outcome.pointing_s, 20.0);
      EXPECT_LT(*outcome.pointing_s, 60.0);
      EXPECT_LT(outcome.settled_s.value_or(800.0), 240.0);
      EXPECT_LT(degrees(outcome.last_off_rad), limit_deg);
      EXPECT_LT(outcome.most_nms, 0.11);
      EXPECT_LT(outcome.most_rad_s, kMostSpeed_rad_s);
    }
  }
}

TEST(OrientationMotion, HoldsItAgainstAConstantTorque) {
  constexpr double kTorque_nm = 5e-5;
  // Without an integral term the error balances the torque.
  const Vector3d expected_rad = kTorque_nm / (0.1 * 0.1) * kMoments_kg_m2.cwiseInverse();
  for (const Knowledge& knowledge : kKnowledge) {
    OrientationTruth disturbed = truth();
    disturbed.body.disturbances.constant_body_nm = Vector3d::Constant(kTorque_nm);
    disturbed.control.by_gyro = knowledge.by_gyro;
    const Orientation flight = flown(disturbed, gyro_with(Vector3d::Zero()));
    const OrientationOutcome outcome = outcome_of(flight, disturbed);
    EXPECT_LT(outcome.settled_s.value_or(800.0), 240.0);
    EXPECT_LT(outcome.most_nms, 0.17);
    EXPECT_LT(outcome.most_rad_s, kMostSpeed_rad_s);
    const Eigen::Quaterniond target =
        disturbed.body.at_start.q_icrf_body * disturbed.control.q_start_target;
    const Vector3d off_rad =
        rotation_vector_of(target.conjugate() * flight.motion.last().q_icrf_body);
    EXPECT_LT(degrees((off_rad - expected_rad).norm()), 0.01);
  }
}

TEST(OrientationMotion, DriftsByTheBiasThatItsComputerTakesForARate) {
  constexpr double kBias_deg_s = 1e-3;
  const OrientationTruth undisturbed = truth();
  const OrientationOutcome outcome =
      outcome_of(flown(undisturbed, gyro_with({0.0, 0.0, kBias_deg_s})), undisturbed);
  // The drift of 800 s, slightly reduced by the rotation in which the axis pointed elsewhere.
  EXPECT_NEAR(degrees(outcome.last_off_rad), 800.0 * kBias_deg_s, 0.05);

  OrientationTruth knowing = undisturbed;
  knowing.control.by_gyro.reset();
  EXPECT_LT(
      degrees(outcome_of(flown(knowing, gyro_with({0.0, 0.0, kBias_deg_s})), knowing).last_off_rad),
      0.001);
}

TEST(OrientationMotion, SettlesWithInertiaAFifthOffLateTorqueAndEitherLaw) {
  for (const auto& [by_gyro, limit_deg] :
       {Knowledge{std::nullopt, 0.01}, {GyroPropagation::Composition, 0.1}}) {
    for (const double factor : {0.8, 1.0, 1.2}) {
      for (const int periods_late : {0, 1}) {
        for (const bool variable_limit : {false, true}) {
          SCOPED_TRACE(::testing::Message() << "inertia times " << factor << ", " << periods_late
                                            << " late, variable limit " << variable_limit);
          OrientationTruth other = truth();
          other.body.inertia_kg_m2 *= factor;
          other.control.periods_late = periods_late;
          other.control.variable_limit = variable_limit;
          other.control.by_gyro = by_gyro;
          const OrientationOutcome outcome =
              outcome_of(flown(other, gyro_with(Vector3d::Zero(), 0.001)), other);
          EXPECT_LT(outcome.settled_s.value_or(800.0), 240.0);
          EXPECT_LT(degrees(outcome.last_off_rad), limit_deg);
        }
      }
    }
  }
}

TEST(OrientationMotion, TellsThatItNeverSettles) {
  OrientationTruth brief = truth();
  brief.body.end_s = 30.0;
  const OrientationOutcome outcome = outcome_of(flown(brief, gyro_with(Vector3d::Zero())), brief);
  EXPECT_FALSE(outcome.settled_s);
  EXPECT_GT(degrees(outcome.last_off_rad), 1.0);
}

TEST(OrientationMotion, RefusesWhatCannotBe) {
  OrientationTruth other = truth();
  other.control.period_s = 2.0;
  other.control.periods_late = 4;
  EXPECT_THAT(refusal_of(other), HasSubstr("is closed every 2 s, 4 periods late, swings"));
  other = truth();
  other.control.wheels.axes_body.col(2) = Vector3d::UnitX();
  EXPECT_THAT(refusal_of(other), HasSubstr("do not span space"));
  other = truth();
  other.control.plan.control_on_s = -1.0;
  EXPECT_THAT(refusal_of(other), HasSubstr("control is on at -1 s"));
  other = truth();
  other.body.at_start.rate_body_rad_s = {0.0, 0.0, 3.0};
  EXPECT_THAT(refusal_of(other), HasSubstr("too coarse for a body that turns by"));
  other = truth();
  other.body.inertia_kg_m2(0, 0) = 3.0;
  EXPECT_THAT(refusal_of(other), HasSubstr("not above the sum of the others"));
}

}  // namespace spindrift::orientation_motion_test
