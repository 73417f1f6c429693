#include <string>
#include <variant>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/reconstruction/separation.h"
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

namespace spindrift::testing::separation_scenario_test {

const std::string kWhole = text_of(scenarios() / "separation.toml");

const SeparationScenario& separation(const Scenario& scenario) {
  return std::get<SeparationScenario>(scenario.flight);
}

SimulatedPass simulated(const std::string& text) { return simulated_pass(loaded(text)).value(); }

template <class Value>
std::size_t count_of(const SimulatedPass& pass) {
  return pass.telemetry.of<Value>().size();
}

TEST(SeparationScenario, TakesWhatIsLeftOutAsTheMissionFileHasIt) {
  const auto scenario = loaded(kWhole);
  const SeparationScenario& flight = separation(scenario);
  EXPECT_DOUBLE_EQ(flight.view.sensors.gyro->noise_rad_s, 0.002 * kRadPerDeg);
  EXPECT_EQ(flight.view.sensors.gyro->sampling.from_s, 60.0);
  EXPECT_EQ(flight.view.sensors.gyro->sampling.step_s, 0.25);
  EXPECT_DOUBLE_EQ(flight.view.sensors.sun_sensor->noise_rad, 0.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.view.sensors.star_tracker->noise_rad, 20.0 / 3600.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.view.bias_sigma_rad_s, 0.01 * kRadPerDeg);
  EXPECT_FALSE(flight.view.bias_rad_s);
  EXPECT_EQ(flight.truth.body.inertia_kg_m2.diagonal(), Eigen::Vector3d(120.0, 100.0, 140.0));
  EXPECT_FALSE(flight.launcher->off_rad);
}

TEST(SeparationScenario, LetsTheTruthDifferFromTheMissionFile) {
  const auto scenario =
      loaded(replaced(kWhole, "sigma_deg = 0.5", "sigma_deg = 0.5\noff_deg = [0, 0, 5]") +
             R"([truth.gyro]
noise_deg_s = 0
bias_deg_s = [0.003, -0.002, 0.004]
[truth.sun_sensor]
noise_deg = 1
half_cone_deg = 60
[truth.star_tracker]
noise_arcsec = 100
)");
  const SeparationScenario& flight = separation(scenario);
  EXPECT_EQ(flight.view.sensors.gyro->noise_rad_s, 0.0);
  EXPECT_DOUBLE_EQ(flight.view.bias_rad_s->z(), 0.004 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.view.sensors.sun_sensor->noise_rad, kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.view.sensors.sun_sensor->half_cone_rad, 60.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.view.sensors.star_tracker->noise_rad, 100.0 / 3600.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(flight.launcher->off_rad->z(), 5.0 * kRadPerDeg);
  EXPECT_THAT(scenario.mission_toml, AllOf(HasSubstr("noise_deg = 0.5"), Not(HasSubstr("truth"))));
}

TEST(SeparationScenario, WritesAMissionFileWithEventsAndWhatTheLauncherTells) {
  const TemporaryFolder folder;
  const auto scenario =
      loaded(replaced(kWhole, "sigma_deg = 0.5", "sigma_deg = 0.5\noff_deg = [0, 0, 5]"));
  const SimulatedPass pass = simulated_pass(scenario).value();
  ASSERT_TRUE(write_pass(folder.path(), scenario, pass));
  for (const char* const name : {"gyro.csv", "sun.csv", "star.csv", "orbit.oem", "truth.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  }

  const auto mission = value_or_throw(load_mission(folder.path() / "mission.toml"));
  EXPECT_EQ(std::get<ThreeAxisConfig>(mission.config).inertia->kg_m2(2, 2), 140.0);
  const SeparationPlan& plan = mission.separation.value();
  EXPECT_EQ(plan.times.separation, scenario.start);
  EXPECT_EQ(plan.times.control_on, shifted(scenario.start, 60.0));
  EXPECT_EQ(plan.times.acquisition, shifted(scenario.start, 78.0));
  EXPECT_EQ(plan.times.first_star_fix, shifted(scenario.start, 300.0));

  // The launcher's attitude is five degrees off the truth.
  const auto& q = pass.truth["T1"]["q_icrf_body_xyzw"];
  const ReconstructedAttitude truth{.t = scenario.start,
                                    .q_icrf_body = {q[3], q[0], q[1], q[2]},
                                    .rate_body_rad_s = Eigen::Vector3d::Zero(),
                                    .covariance_rad2 = 1e-12 * Eigen::Matrix3d::Identity(),
                                    .rate_covariance_rad2_s2 = Eigen::Matrix3d::Zero()};
  const auto check = value_or_throw(launcher_check(plan.launcher.value(), truth, mission.orbit));
  EXPECT_NEAR(check.difference.angle_rad, 5.0 * kRadPerDeg, 1e-6);
  EXPECT_NEAR(check.difference.chi_square, 100.0, 0.01);
}

TEST(SeparationScenario, SimulatesAMagnetometerWhereThereIsOne) {
  const std::string with_field = kWhole + "[three_axis.magnetometer]\nnoise_nt = 100\n";
  const auto scenario = loaded(with_field);
  const TrueMagnetometer& as_said = separation(scenario).view.sensors.magnetometer.value();
  EXPECT_EQ(as_said.noise_nt, 100.0);
  EXPECT_EQ(as_said.bias_nt, Eigen::Vector3d::Zero());
  EXPECT_EQ(as_said.sampling.from_s, 60.0);
  EXPECT_EQ(as_said.sampling.step_s, 1.0);

  const auto other = loaded(replaced(with_field, "[three_axis.gyro]",
                                     "[telemetry]\nmagnetometer_step_s = 0.5\n"
                                     "[truth.magnetometer]\nnoise_nt = 10\nbias_nt = [1, 2, 3]\n"
                                     "[three_axis.gyro]"));
  const TrueMagnetometer& really = separation(other).view.sensors.magnetometer.value();
  EXPECT_EQ(really.noise_nt, 10.0);
  EXPECT_EQ(really.bias_nt, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(really.sampling.step_s, 0.5);

  const SimulatedPass pass = simulated(replaced(with_field, "lost = 0.01", "lost = 0"));
  EXPECT_EQ(count_of<MagneticField>(pass), 250U);
  EXPECT_EQ(pass.made.back().plural, "magnetometer samples");
  EXPECT_EQ(pass.kinds.size(), 4U);
  EXPECT_THAT(pass.mission_toml, HasSubstr("[three_axis.magnetometer]"));
  EXPECT_EQ(simulated(kWhole).kinds.size(), 3U);
}

TEST(SeparationScenario, GivesTheSamePassForTheSameSeed) {
  const SimulatedPass first = simulated(kWhole);
  const SimulatedPass second = simulated(kWhole);
  const SimulatedPass other = simulated(replaced(kWhole, "seed = 22", "seed = 23"));
  EXPECT_EQ(first.truth, second.truth);
  EXPECT_EQ(first.mission_toml, second.mission_toml);
  const auto& gyro = first.telemetry.of<GyroSample>();
  EXPECT_EQ(gyro.back().value.rate_body_rad_s,
            second.telemetry.of<GyroSample>().back().value.rate_body_rad_s);
  EXPECT_NE(gyro.back().value.rate_body_rad_s,
            other.telemetry.of<GyroSample>().back().value.rate_body_rad_s);
  EXPECT_NE(first.truth["gyro_bias_deg_s"], other.truth["gyro_bias_deg_s"]);
  // The motion contains nothing random.
  EXPECT_EQ(first.truth["T4"]["q_icrf_body_xyzw"], other.truth["T4"]["q_icrf_body_xyzw"]);
}

TEST(SeparationScenario, CountsWhatItMadeAndWhatIsMissing) {
  const SimulatedPass pass = simulated(kWhole);
  // 997 rates less 8 in the gap, 232 sun vectors, 10 fixes.
  const auto missing = pass.truth["missing"].get<std::size_t>();
  EXPECT_GT(missing, 0U);
  EXPECT_EQ(
      count_of<GyroSample>(pass) + count_of<SunDirection>(pass) + count_of<StarFix>(pass) + missing,
      989U + 232U + 10U);
  EXPECT_GT(pass.truth["sun_outliers"].size(), 0U);
  EXPECT_EQ(pass.made[0].plural, "gyro samples");
  EXPECT_EQ(pass.made[0].count, static_cast<std::int64_t>(count_of<GyroSample>(pass)));
  EXPECT_EQ(pass.faults[0].count, static_cast<std::int64_t>(missing));
}

TEST(SeparationScenario, OrdersTelemetryByTime) {
  TaiTime last = tai_from_ns(0);
  std::size_t seen = 0;
  const SimulatedPass pass = simulated(kWhole);
  in_order_of_arrival(pass.telemetry, [&](const auto& arrived) {
    EXPECT_GE(arrived.value.t, last);
    last = arrived.value.t;
    ++seen;
  });
  EXPECT_EQ(seen, count_of(pass.telemetry));
}

TEST(SeparationScenario, ReportsMistakesAtOnce) {
  std::string text = replaced(kWhole, "rate_deg_s = [0.62, -0.33, 0.066]", "rate_deg_s = [62, 0]");
  text = replaced(text, "euler312_icrf_deg", "euler312_deg");
  text = replaced(text, "acquisition_s = 78.0", "acquisition_s = 50.0");
  text = replaced(text, "first_star_fix_s = 300.0", "first_star_fix_s = 310.0");
  text = replaced(text, "torque_nm = 0.07", "torque_nm = 70");
  text = replaced(text, "noise_arcsec = 20.0", "");
  text = replaced(text, "[0.0, 100.0, 0.0]", "[0.0, -100.0, 0.0]");
  text = replaced(text, "[three_axis.gyro]\nnoise_deg_s = 0.002\nbias_sigma_deg_s = 0.01\n", "");
  text = replaced(text, "lost = 0.01", "lost = nan\nspoilt = 0.5");
  text = replaced(text, "to_s = 152.0", "to_s = 140.0");
  text += "[truth.magnetometer]\nbias_nt = [1, 2]\n[spin.noise]\nsun_pulse_s = 1\n";
  expect_problems(text,
                  {"attitude.rate_deg_s = [ 62, 0 ]: must be",
                   "attitude.euler312_deg: unknown; did you mean "
                   "euler312_icrf_deg?",
                   "separation.acquisition_s = 50: must not be below control_on_s = 60",
                   "separation.first_star_fix_s = 310: must not be above pass.duration_s = 309",
                   "three_axis.star_tracker.noise_arcsec: missing",
                   "three_axis.inertia.kg_m2 = ", "[three_axis.gyro]: missing",
                   "faults.lost = nan: must lie in [0, 1]", "faults.spoilt: unknown",
                   "faults.gyro_gap[0].to_s = 140: must not be below from_s = 150",
                   "truth.magnetometer.bias_nt = [ 1, 2 ]: must be", "spin: unknown"});
}

TEST(SeparationScenario, RefusesPulsesOutOfOrderAndThrustersThatThrowTheBodyAcrossTheDeadBand) {
  const auto with_torque = [](const std::string& torque) {
    return replaced(kWhole, "torque_nm = 0.07", "torque_nm = " + torque);
  };
  expect_problems(with_torque("0.07\nshortest_pulse_s = 0.1\nlongest_pulse_s = 0.08"),
                  {"control.period_s = 0.05: must not be below shortest_pulse_s = 0.1",
                   "longest_pulse_s = 0.08: must not be below shortest_pulse_s = 0.1"});
  EXPECT_THAT(error_of(with_torque("2")),
              HasSubstr("control.torque_nm = 2: changes the rate by 0.0573 deg/s in 0.05 s: must "
                        "not change it by more than control.dead_band_deg_s = 0.03"));
  EXPECT_THAT(error_of(replaced(kWhole, "duration_s = 309.0", "duration_s = 100000")),
              HasSubstr("pass.duration_s = 100000: must lie in (0, 86400] s"));
}

TEST(SeparationScenario, RefusesASpinnersScenarioThatSaysItIsThreeAxis) {
  const std::string spinner = text_of(scenarios() / "gto-nominal.toml");
  EXPECT_THAT(error_of(replaced(spinner, "kind = \"spin\"", "kind = \"three_axis\"")),
              AllOf(HasSubstr("spin: unknown"), HasSubstr("[separation]: missing"),
                    HasSubstr("attitude.rate_rpm: unknown")));
}

}  // namespace spindrift::testing::separation_scenario_test
