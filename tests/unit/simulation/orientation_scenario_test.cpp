#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "pipelines/frames/angle.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/scenario_text.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing::orientation_scenario_test {

const std::string kWhole = text_of(scenarios() / "upper-stage.toml");

const OrientationControl& control(const Scenario& scenario) {
  return std::get<OrientationScenario>(scenario.flight).truth.control;
}

TEST(OrientationScenario, ReadsTheSatelliteOfSeed004) {
  const auto scenario = loaded(kWhole);
  const OrientationControl& read = control(scenario);
  EXPECT_EQ(read.plan.control_on_s, 2.0);
  EXPECT_DOUBLE_EQ(read.plan.damped_rad_s, 0.1 * kRadPerDeg);
  EXPECT_EQ(read.plan.pointing_at_s, 100.0);
  EXPECT_NEAR(read.q_start_target.w(), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(read.q_start_target.x(), std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(Eigen::Matrix3d{read.wheels.axes_body}.isIdentity());
  EXPECT_NEAR(read.wheels.inertia_kg_m2, 0.3 / (200.0 * std::numbers::pi), 1e-15);
  EXPECT_EQ(read.moments_kg_m2, Eigen::Vector3d(0.6, 1.2, 1.12));
  EXPECT_EQ(read.by_gyro, GyroPropagation::RungeKutta);
  EXPECT_EQ(read.damping, 0.6716);
  EXPECT_FALSE(read.variable_limit);
}

TEST(OrientationScenario, ReadsOtherWheelsAndLaws) {
  std::string text =
      replaced(kWhole, "torque_nm_most = 0.01",
               "torque_nm_most = 0.01\n"
               "[[wheels.axis]]\nbody = [1, 1, 1]\n[[wheels.axis]]\nbody = [-1, 1, 1]\n"
               "[[wheels.axis]]\nbody = [1, -1, 1]\n[[wheels.axis]]\nbody = [1, 1, -1]");
  text = replaced(
      text, "period_s = 0.1",
      "period_s = 0.2\nlaw = \"variable_limit\"\nattitude_by = \"truth\"\nperiods_late = 2");
  const auto scenario = loaded(text);
  EXPECT_EQ(control(scenario).wheels.axes_body.cols(), 4);
  EXPECT_EQ(control(scenario).wheels.axes_body.col(1), Eigen::Vector3d(-1.0, 1.0, 1.0));
  EXPECT_TRUE(control(scenario).variable_limit);
  EXPECT_FALSE(control(scenario).by_gyro);
  EXPECT_EQ(control(scenario).periods_late, 2);
}

TEST(OrientationScenario, TellsWhatTheControlReached) {
  const auto scenario = loaded(kWhole);
  const SimulatedPass pass = simulated_pass(scenario).value();
  EXPECT_GT(pass.truth["pointing_s"], 20.0);
  EXPECT_LT(pass.truth["settled_s"], 240.0);
  EXPECT_LT(pass.truth["last_off_deg"], 1.0);
  EXPECT_LT(pass.truth["wheel_nms_most"], 0.17);
  EXPECT_LT(pass.truth["wheel_rpm_most"], 6000.0);
  EXPECT_EQ(pass.truth["history"].size(), 81U);
  EXPECT_EQ(pass.telemetry.of<GyroSample>().size(), 3201U);
  EXPECT_EQ(pass.telemetry.of<StarFix>().size(), 801U);
}

TEST(OrientationScenario, ReportsMistakesAtOnce) {
  std::string text = replaced(kWhole, "control_on_s = 2.0", "control_on_s = -2.0");
  text = replaced(text, "q_start_target = [0.7071, 0.0", "q_start_target = [0.5, 0.0");
  text = replaced(text, "speed_rpm_most = 6000.0", "speed_rpm_most = 0");
  text = replaced(text, "[three_axis.gyro]\nnoise_deg_s = 0.001\nbias_sigma_deg_s = 0.001\n", "");
  expect_problems(text, {"orientation.control_on_s = -2.0: must lie in [0, 86400] s",
                         "orientation.q_start_target = ",
                         "wheels.speed_rpm_most = 0: must lie in (0, 1000000] rpm",
                         "control.attitude_by = \"runge_kutta\": there is no [three_axis.gyro]"});
}

TEST(OrientationScenario, RefusesWhatDoesNothingSwingsOrTurnsTooFast) {
  const std::string axis = "\n[[wheels.axis]]\nbody = ";
  const auto with_wheels = [](const std::string& axes) {
    return replaced(kWhole, "torque_nm_most = 0.01", "torque_nm_most = 0.01" + axes);
  };
  std::string nine;
  for (int i = 0; i < 9; ++i) {
    nine += axis + "[1, 0, 0]";
  }
  // A needle that rotates across its long axis may end up rotating about it.
  const std::string needle =
      replaced(replaced(kWhole, "rate_deg_s = [3.0, -3.0, 3.0]", "rate_deg_s = [10, -10, 10]"),
               "[[0.6, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, 0.0, 1.12]]",
               "[[0.02, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, 0.0, 1.2]]");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {with_wheels(axis + "[1, 0, 0]" + axis + "[0, 1, 0]"),
       "[[wheels.axis]]: the axes of 2 wheels do not span space"},
      {with_wheels(nine), "[[wheels.axis]]: 9 wheels: must be 8 at most"},
      {kWhole + "\n[truth.sun_sensor]\nnoise_deg = 1\n",
       "[truth.sun_sensor]: there is no [three_axis.sun_sensor]"},
      {replaced(kWhole, "control_on_s = 2.0", "control_on_s = 2000.0"),
       "orientation.control_on_s = 2000: must not be above pass.duration_s"},
      {replaced(kWhole, "period_s = 0.1", "period_s = 2.0\nperiods_late = 4"),
       "control.period_s = 2, periods_late = 4: a loop of 0.1502 rad/s"},
      {needle,
       "control.period_s = 0.1: a step of 0.05 s is too coarse for a body that turns by 2.342 "
       "rad/s"}};
  for (const auto& [text, problem] : cases) {
    EXPECT_THAT(error_of(text), HasSubstr(problem));
  }
}

}  // namespace spindrift::testing::orientation_scenario_test
