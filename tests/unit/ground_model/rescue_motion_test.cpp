#include "pipelines/ground_model/flights/rescue_motion.h"

#include "tests/support/commanded_flight.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/rescue_trials.h"

namespace spindrift::testing::rescue_motion_test {

TEST(RescueMotion, TurnsATumblingBodyToTheCommandedAttitudeOnceThatIsSafe) {
  const Rescue rescue = value_or_throw(rescued(tumbling_to_rescue(0, 2'500.0), 0));
  const RescueOutcome outcome = outcome_of(rescue);
  EXPECT_EQ(outcome.lost_s, 9.0);
  ASSERT_TRUE(outcome.controlled_s);
  EXPECT_GE(*outcome.controlled_s, *outcome.lost_s + 600.0) << "the window of the safe gate";
  EXPECT_LT(*outcome.error_at_safe_rad, 5.0 * kRadPerDeg);
  ASSERT_TRUE(outcome.reached_s);
  EXPECT_GT(*outcome.reached_s, *outcome.controlled_s);
  EXPECT_LT(outcome.last_off_rad, 6.0 * kRadPerDeg);
  EXPECT_FALSE(fires_while_lost(rescue));
}

TEST(RescueMotion, OfSensorsThatFailBeginsWhereTheBodyLeavesTheCommandedAttitude) {
  RescueTruth truth = tumbling_to_rescue(0, 400.0);
  const Orbit orbit = low_orbit(at_s(0.0));
  const Eigen::Matrix3d axes = axes_of_orbit(orbit.at(at_s(0.0)).value());
  truth.body.at_start = {.q_icrf_body = Eigen::Quaterniond{axes},
                         .rate_body_rad_s = {0.0, -0.061 * kRadPerDeg, 0.0}};
  truth.control.failure =
      SensorFailure{.t_s = 200.0, .turns_rad_s = Eigen::Vector3d{0.0, 0.2, 0.0} * kRadPerDeg};
  const Rescue rescue = value_or_throw(rescued(truth, 0));
  EXPECT_LT(rescue.record.at(199).off_rad, 1.0 * kRadPerDeg);
  const RescueOutcome outcome = outcome_of(rescue);
  ASSERT_TRUE(outcome.lost_s);
  EXPECT_GT(*outcome.lost_s, 220.0);
  EXPECT_LT(*outcome.lost_s, 300.0);
  for (const RescueRecord& now : rescue.record) {
    EXPECT_EQ(now.phase == RescuePhase::Pointing, now.t_s < *outcome.lost_s);
    EXPECT_TRUE(now.phase == RescuePhase::Pointing || now.torque_nm.isZero(0.0));
  }
}

TEST(RescueMotion, RefusesImpossibleThrusters) {
  RescueTruth truth = tumbling_to_rescue(0, 10.0);
  truth.control.thrusters.torque_nm = 0.0;
  EXPECT_THAT(rescued(truth, 0),
              IsRefused(ErrorCode::InvalidConfiguration, HasSubstr("thrusters")));
}

}  // namespace spindrift::testing::rescue_motion_test
