#include <string>
#include <variant>

#include "pipelines/frames/angle.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/scenario_text.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing::rescue_scenario_test {

const std::string kWhole = text_of(scenarios() / "rescue.toml");

TEST(RescueScenario, ReadsWhatFailsAndWhatBringsTheBodyBack) {
  const auto scenario = loaded(kWhole);
  const RescueTruth& truth = std::get<RescueScenario>(scenario.flight).truth;
  const RescueControl& control = truth.control;
  EXPECT_EQ(control.commanded.frame, NominalAttitude::Frame::Orbit);
  EXPECT_EQ(control.failure.value().t_s, 600.0);
  EXPECT_DOUBLE_EQ(control.failure->turns_rad_s.y(), 0.1 * kRadPerDeg);
  EXPECT_EQ(control.thrusters.torque_nm, 0.5);
  EXPECT_EQ(control.thrusters.longest_s, 1.0);
  EXPECT_EQ(control.period_s, 1.0);
  EXPECT_EQ(truth.magnetometer.noise_nt, 100.0);
  EXPECT_EQ(truth.filter.inertia_kg_m2, truth.body.inertia_kg_m2);
}

TEST(RescueScenario, NeedsTheCommandedAttitudeAndTheMagnetometer) {
  expect_problems(
      replaced(replaced(kWhole, "[three_axis.nominal]\nq_orbit_body = [0.0, 0.0, 0.0, 1.0]\n", ""),
               "[three_axis.magnetometer]\nnoise_nt = 100.0\n", ""),
      {"[three_axis.nominal]: missing", "[three_axis.magnetometer]: missing"});
  expect_problems(replaced(kWhole, "torque_nm = 0.5", "torque_nm = 0.5\nshortest_s = 2"),
                  {"thrusters.longest_s = 1"});
}

/// Without a failure the body tumbles until it is found.
TEST(RescueScenario, BeginsWithNoControlWhereNothingFails) {
  const auto scenario = loaded(
      replaced(replaced(kWhole, "[rescue]\nfails_s = 600.0\nturns_deg_s = [0.05, 0.1, 0.03]\n", ""),
               "[7.9, -90.0, 10.0]", "[40.0, 20.0, 100.0]"));
  const SimulatedPass pass = value_or_throw(simulated_pass(scenario, Progress::Hidden));
  EXPECT_EQ(pass.truth["lost_s"], 9.0);
  EXPECT_LT(pass.truth["last_off_deg"], 6.0);
}

}  // namespace spindrift::testing::rescue_scenario_test
