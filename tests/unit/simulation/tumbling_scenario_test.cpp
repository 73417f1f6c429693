#include <string>
#include <variant>

#include "pipelines/frames/angle.h"
#include "services/mission/mission.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/scenario_text.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::testing::tumbling_scenario_test {

const std::string kWhole = text_of(scenarios() / "tumbling.toml");

const TumblingScenario& tumbling(const Scenario& scenario) {
  return std::get<TumblingScenario>(scenario.flight);
}

TEST(TumblingScenario, ReadsWhatTurnsTheBody) {
  const auto scenario = loaded(kWhole + R"([truth.inertia]
factor = 1.5
[disturbances.periodic]
amplitude_nm = [1e-5, 0, 2e-5]
period_s = 6000
phase_deg = 90
[disturbances.drag]
density_kg_m3 = 1e-13
area_m2 = 2
centre_of_pressure_m = [0, 0, 0.1]
)");
  const TumblingTruth& truth = tumbling(scenario).truth;
  EXPECT_EQ(truth.wheels_body_nms, Eigen::Vector3d(0.0, -0.4, 0.0));
  EXPECT_EQ(truth.body.inertia_kg_m2.diagonal(), Eigen::Vector3d(24.0, 27.0, 18.0));
  EXPECT_EQ(truth.body.end_s, 1800.0);
  const Disturbances& disturbances = truth.body.disturbances;
  EXPECT_TRUE(disturbances.gravity_gradient);
  EXPECT_EQ(disturbances.dipole_body_a_m2, Eigen::Vector3d(0.3, -0.2, 0.1));
  EXPECT_TRUE(truth.body.field);
  EXPECT_TRUE(disturbances.constant_body_nm.isZero());
  EXPECT_DOUBLE_EQ(disturbances.periodic.rate_rad_s, kTurn_rad / 6000.0);
  EXPECT_DOUBLE_EQ(disturbances.periodic.phase_rad, 90.0 * kRadPerDeg);
  EXPECT_EQ(disturbances.drag->coefficient, 2.2);
  EXPECT_EQ(disturbances.drag->centre_of_pressure_body_m.z(), 0.1);
}

TEST(TumblingScenario, SendsWhatItsSensorsMeasure) {
  const TemporaryFolder folder;
  const auto scenario = loaded(kWhole);
  const SimulatedPass pass = simulated_pass(scenario).value();
  ASSERT_TRUE(write_pass(folder.path(), scenario, pass));
  for (const char* const name :
       {"gyro.csv", "sun.csv", "star.csv", "magnetometer.csv", "orbit.oem", "truth.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }
  // The star tracker starts late, and one sample in a hundred is lost.
  EXPECT_GE(pass.telemetry.of<StarFix>().front().value.t, shifted(scenario.start, 1200.0));
  EXPECT_NEAR(static_cast<double>(pass.telemetry.of<StarFix>().size()), 595.0, 15.0);
  EXPECT_NEAR(static_cast<double>(pass.telemetry.of<MagneticField>().size()), 1783.0, 30.0);

  const auto mission = value_or_throw(load_mission(folder.path() / "mission.toml"));
  EXPECT_FALSE(mission.separation);
  EXPECT_TRUE(std::get<ThreeAxisConfig>(mission.config).magnetometer);
}

TEST(TumblingScenario, TellsTheTruthAllThrough) {
  const auto scenario = loaded(kWhole);
  const SimulatedPass pass = simulated_pass(scenario).value();
  const auto& history = pass.truth["history"];
  ASSERT_EQ(history.size(), 181U);
  EXPECT_EQ(history[0][0], pass.truth["start"]["t_tai_ns"]);
  EXPECT_EQ(history[180][0], pass.truth["end"]["t_tai_ns"]);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(history[180][1 + i], pass.truth["end"]["q_icrf_body_xyzw"][i]);
  }
  EXPECT_NEAR(history[0][5].get<double>(), 1.2, 1e-12);
}

TEST(TumblingScenario, FliesWithTheSensorsThatThereAre) {
  const std::string without = replaced(kWhole,
                                       "[three_axis.gyro]\nnoise_deg_s = 0.002\nrange_deg_s = 3.0\n"
                                       "bias_sigma_deg_s = 0.005\n",
                                       "");
  const auto scenario = loaded(without);
  const SimulatedPass pass = simulated_pass(scenario).value();
  EXPECT_TRUE(pass.telemetry.of<GyroSample>().empty());
  EXPECT_FALSE(pass.telemetry.of<MagneticField>().empty());
  EXPECT_EQ(pass.kinds.size(), 3U);
}

TEST(TumblingScenario, ReportsMistakesAtOnce) {
  std::string text = replaced(kWhole, "[0.0, 18.0, 0.0]", "[0.0, 180.0, 0.0]");
  text = replaced(text, "first_star_fix_s = 1200.0", "first_star_fix_s = 1900.0");
  text = replaced(text, "dipole_a_m2 = [0.3, -0.2, 0.1]", "dipole_a_m2 = [0.3]\nsolar = true");
  text = replaced(text, "duration_s = 1800.0", "duration_s = -1800.0");
  text += "[disturbances.drag]\ndensity_kg_m3 = -1\n[separation]\ncontrol_on_s = 0\n";
  expect_problems(
      text,
      {"three_axis.inertia.kg_m2 = ", "pass.duration_s = -1800.0: must lie in (0, 86400] s",
       "disturbances.dipole_a_m2 = [ 0.29999999999999999 ]: must be", "disturbances.solar: unknown",
       "disturbances.drag.density_kg_m3 = -1: must lie in [0, 1]",
       "disturbances.drag.area_m2: missing", "separation: unknown"});
  EXPECT_THAT(
      error_of(replaced(kWhole, "first_star_fix_s = 1200.0", "first_star_fix_s = 1900.0")),
      HasSubstr("tumbling.first_star_fix_s = 1900: must not be above pass.duration_s = 1800"));
  EXPECT_THAT(error_of(replaced(kWhole, "model = \"tumbling\"", "model = \"spin\"")),
              HasSubstr("attitude.model = 'spin': must be"));
}

TEST(TumblingScenario, RefusesOneThatSendsNothing) {
  std::string text = kWhole.substr(0, kWhole.find("[three_axis.gyro]")) +
                     kWhole.substr(kWhole.find("[three_axis.inertia]"));
  EXPECT_THAT(error_of(text), HasSubstr("[three_axis]: must have gyro, sun_sensor"));
}

TEST(CarriedTable, NeedsElementsAndBothSensors) {
  const std::string text = text_of(scenarios() / "femto.toml");
  EXPECT_EQ(loaded(text).carried_table->points, 80);
  expect_problems(replaced(replaced(text, "[three_axis.magnetometer]\nnoise_nt = 100.0", ""),
                           "[truth.magnetometer]\nnoise_nt = 10.0", ""),
                  {"[field_table]: needs [three_axis.magnetometer]"});
  expect_problems(kWhole.substr(0, kWhole.find("[orbit.elements]")) + "[orbit]\noem = \"a.oem\"\n" +
                      kWhole.substr(kWhole.find("[pass]")) +
                      "[field_table]\nkind = \"uniform\"\npoints = 80\n",
                  {"[field_table]: needs [orbit.elements]"});
  expect_problems(replaced(text, "points = 80", "points = 3"), {"field_table.points = 3"});
  expect_problems(replaced(text, "\"curvature\"", "\"cubic\""), {"field_table.kind"});
}

}  // namespace spindrift::testing::tumbling_scenario_test
