#include "services/simulation/scenario.h"

#include <algorithm>
#include <chrono>
#include <numbers>

#include "pipelines/ephemeris/oem.h"
#include "pipelines/ephemeris/oem_writer.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/base/input_file.h"
#include "services/mission/mission.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/scenario_schema.h"
#include "services/simulation/simulated_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/scenario_text.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"

namespace spindrift::testing::scenario_test {

const std::filesystem::path kScenarios = scenarios();

const std::string kSpacecraft = R"([spacecraft]
id = "SPINNER"
kind = "spin"
)";
const std::string kOrbit = R"([orbit.elements]
epoch_tai_ns = 1795143637000000000
a_km = 24400.0
e = 0.73
i_deg = 28.5
raan_deg = 300.0
argp_deg = 178.0
mean_anomaly_deg = 30.0
)";
const std::string kPass = R"([pass]
start_utc = "2026-11-20T03:00:00Z"
duration_s = 20.0
)";
const std::string kAttitude = R"([attitude]
model = "spin"
ra_deg = 100.0
dec_deg = -55.0
rate_rpm = 60.0
)";
const std::string kSensors = R"([spin.sun_sensor]
slit_cant_deg = 45.0
slit_separation_deg = 35.0
[spin.ir.north]
mount_angle_deg = 85.0
azimuth_deg = 90.0
[spin.ir.south]
mount_angle_deg = 95.0
azimuth_deg = 92.0
[spin.noise]
sun_pulse_s = 1.0e-4
ir_pulse_s = 5.0e-4
[spin.horizon]
model = "sphere"
co2_altitude_km = 40.0
)";
const std::string kWhole = kSpacecraft + kOrbit + kPass + kAttitude + kSensors;

const SpinScenario& spin(const Scenario& scenario) {
  return std::get<SpinScenario>(scenario.flight);
}

std::string truth_text(const Scenario& scenario) {
  return simulated_pass(scenario).value().truth.dump(1);
}

TEST(Scenario, SchemasOfTheProgramAreSound) {
  for (const auto& [kind, tables] :
       {std::pair{ScenarioKind::Spin, 9U}, std::pair{ScenarioKind::Separation, 13U},
        std::pair{ScenarioKind::Tumbling, 12U}, std::pair{ScenarioKind::Orientation, 14U},
        std::pair{ScenarioKind::Rescue, 14U}}) {
    const auto schema = value_or_throw(scenario_schema(kind));
    EXPECT_EQ(schema.tables.size(), tables);
  }
}

TEST(Scenario, LoadsThoseThatComeWithTheProgram) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator{kScenarios}) {
    if (entry.path().extension() == ".toml") {
      SCOPED_TRACE(entry.path());
      const auto scenario = load_scenario(entry.path());
      EXPECT_TRUE(scenario) << scenario.error().message;
      ++count;
    }
  }
  EXPECT_EQ(count, 9);
}

TEST(Scenario, TakesWhatIsLeftOutAsTheMissionFileHasIt) {
  const auto scenario = loaded(kWhole);
  EXPECT_EQ(scenario.start, parse_utc("2026-11-20T03:00:00Z").value());
  EXPECT_DOUBLE_EQ(spin(scenario).truth.motion.rate_rad_s, 2.0 * std::numbers::pi);
  EXPECT_EQ(spin(scenario).truth.motion.rate_drift_rad_s2, 0.0);
  EXPECT_LT(angle_between_rad(spin(scenario).truth.motion.axis_icrf,
                              direction_icrf({100.0 * kRadPerDeg, -55.0 * kRadPerDeg})),
            1e-12);
  EXPECT_DOUBLE_EQ(spin(scenario).truth.north->mount_angle_rad, 85.0 * kRadPerDeg);
  EXPECT_EQ(spin(scenario).truth.horizon.equatorial_km, spin(scenario).truth.horizon.polar_km);
  // The pole of date: precession since J2000 at 20 arcsec a year.
  EXPECT_NEAR(angle_between_rad(spin(scenario).truth.horizon.pole_icrf, Eigen::Vector3d::UnitZ()),
              26.88 * 20.04 / 3600.0 * kRadPerDeg, 1e-5);
  EXPECT_EQ(spin(scenario).link.seed, 1U);
  EXPECT_EQ(spin(scenario).link.noise.infrared_s, 5e-4);
  EXPECT_TRUE(spin(scenario).link.silences.empty());
  EXPECT_TRUE(spin(scenario).telemetry.pulses);
  EXPECT_FALSE(spin(scenario).telemetry.coded);
}

TEST(Scenario, LetsTheTruthDifferFromTheMissionFile) {
  const auto scenario = loaded(kWhole + R"([truth.sun_sensor]
slit_cant_offset_deg = 0.5
slit_separation_offset_deg = -0.25
[truth.ir.north]
mount_angle_offset_deg = 0.1
azimuth_offset_deg = -0.2
chord_excess_deg = 0.3
[truth.noise]
sun_pulse_s = 0
[truth.horizon]
model = "ellipsoid"
co2_altitude_km = 30
)");
  const SpinTruth& truth = spin(scenario).truth;
  EXPECT_DOUBLE_EQ(truth.sun_sensor.slit_cant_rad, 45.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(truth.sun_sensor.slit_separation_rad, 34.75 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(truth.north->mount_angle_rad, 85.1 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(truth.north->azimuth_rad, 89.8 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(truth.north->chord_excess_rad, 0.3 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(truth.south->mount_angle_rad, 95.0 * kRadPerDeg);
  EXPECT_EQ(spin(scenario).link.noise.sun_s, 0.0);
  EXPECT_EQ(spin(scenario).link.noise.infrared_s, 5e-4);
  EXPECT_DOUBLE_EQ(truth.horizon.equatorial_km, 6408.137);
  EXPECT_DOUBLE_EQ(truth.horizon.polar_km, 6386.752314245);
  EXPECT_THAT(scenario.mission_toml, AllOf(HasSubstr("'sphere'"), Not(HasSubstr("truth"))));
}

TEST(Scenario, NutatesAndConesWhereItSaysSo) {
  const auto steady = loaded(kWhole);
  EXPECT_EQ(spin(steady).truth.motion.nutation.half_angle_rad, 0.0);
  EXPECT_EQ(spin(steady).truth.motion.coning.tilt_rad, 0.0);
  EXPECT_THAT(truth_text(steady), AllOf(Not(HasSubstr("nutation")), Not(HasSubstr("coning"))));

  const auto wobbling = loaded(replaced(kWhole, "rate_rpm = 60.0\n", R"(rate_rpm = 60.0
[attitude.nutation]
half_angle_deg = 0.2
inertia_ratio = 0.4
phase_deg = 30.0
[attitude.coning]
tilt_deg = 0.5
)"));
  const SpinMotion& motion = spin(wobbling).truth.motion;
  EXPECT_DOUBLE_EQ(motion.nutation.half_angle_rad, 0.2 * kRadPerDeg);
  EXPECT_EQ(motion.nutation.inertia_ratio, 0.4);
  EXPECT_DOUBLE_EQ(motion.nutation.first_azimuth_rad, 30.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(motion.coning.tilt_rad, 0.5 * kRadPerDeg);
  EXPECT_EQ(motion.coning.azimuth_rad, 0.0);
  // At 60 rpm the period is 1/0.4 s, less a second-order term of the half-angle.
  EXPECT_THAT(truth_text(wobbling),
              AllOf(HasSubstr("\"period_s\": 2.49999"), HasSubstr("\"tilt_deg\": 0.5")));

  const std::string error = error_of(replaced(
      kWhole, "rate_rpm = 60.0\n", "rate_rpm = 60.0\n[attitude.nutation]\nhalf_angle_deg = 11\n"));
  EXPECT_THAT(error, AllOf(HasSubstr("attitude.nutation.half_angle_deg = 11: must lie in [0, 10]"),
                           HasSubstr("inertia_ratio")));
}

TEST(Scenario, ReadsTheFaultsOfEachChannelAndTheSilences) {
  const auto scenario = loaded(kWhole + R"([faults]
lost = 0.05
spurious = 0.02
interference_s = 0.001
[faults.channel.north_in]
lost = 0.5
[faults.channel.sun2]
dead = true
[[faults.silence]]
from_s = 1
to_s = 2
[[faults.silence]]
from_s = 5
to_s = 5.5
)");
  const auto& channels = spin(scenario).link.channels;
  EXPECT_EQ(channels.at(index_of(PulseChannel::Sun1)).lost, 0.05);
  EXPECT_EQ(channels.at(index_of(PulseChannel::NorthIn)).lost, 0.5);
  EXPECT_EQ(channels.at(index_of(PulseChannel::NorthIn)).spurious, 0.02);
  EXPECT_TRUE(channels.at(index_of(PulseChannel::Sun2)).dead);
  EXPECT_FALSE(channels.at(index_of(PulseChannel::Sun1)).dead);
  EXPECT_EQ(spin(scenario).link.interference_s, 0.001);
  ASSERT_EQ(spin(scenario).link.silences.size(), 2U);
  EXPECT_EQ(spin(scenario).link.silences[1].from_s, 5.0);
  EXPECT_EQ(spin(scenario).link.silences[1].to_s, 5.5);
}

TEST(Scenario, WritesAMissionFileThatSaysTheSame) {
  const TemporaryFolder folder;
  const auto scenario = loaded(replaced(kWhole, "SPINNER", "A\\\"B 'C") +
                               "[spin.prior]\nra_deg = 101\ndec_deg = -54.3\nsigma_deg = 5\n");
  const auto pass = value_or_throw(simulated_pass(scenario));
  ASSERT_TRUE(write_pass(folder.path(), scenario, pass));

  const auto mission = value_or_throw(load_mission(folder.path() / "mission.toml"));
  EXPECT_EQ(mission.spacecraft_id, "A\"B 'C");
  EXPECT_EQ(mission.spin()->noise.infrared_s, 5e-4);
  EXPECT_DOUBLE_EQ(mission.spin()->north->mount_angle_rad, 85.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(mission.spin()->prior->sigma_rad, 5.0 * kRadPerDeg);
  const TaiTime t = shifted(scenario.start, 7.5);
  EXPECT_LT((mission.orbit->at(t).value().position_icrf_km -
             scenario.orbit.at(t).value().position_icrf_km)
                .norm(),
            1e-6);
}

TEST(Scenario, ReportsTenMistakesAtOnce) {
  std::string text = kSpacecraft + kOrbit + kPass + kAttitude + kSensors;
  text = replaced(text, "kind = \"spin\"", "kind = \"spinning\"");
  text = replaced(text, "e = 0.73", "e = 1.5");
  text = replaced(text, "duration_s = 20.0", "duration_s = 0");
  text = replaced(text, "2026-11-20T03:00:00Z", "tomorrow");
  text = replaced(text, "rate_rpm = 60.0", "rate_rpm = 0");
  text = replaced(text, "ra_deg = 100.0", "right_ascension = 100.0");
  text = replaced(text, "model = \"spin\"", "model = \"tumbling\"");
  text = replaced(text, "slit_cant_deg = 45.0", "slit_cant_deg = \"steep\"");
  text += "[faults]\nlost = 1.5\nspoilt_min_s = 0.5\n[faults.channel.sun3]\ndead = true\n";
  text += "[truth.noise]\nsun_pulse_s = nan\n[telemetry]\nkind = \"smoke\"\n";
  expect_problems(
      text,
      {"scenario.toml:3: spacecraft.kind = 'spinning': must be one of \"spin\", \"three_axis\"",
       "orbit.elements.e = 1.5: must lie in [0, 0.99]",
       "pass.duration_s = 0: must lie in (0, 604800] s",
       "pass.start_utc = \"tomorrow\": ", "attitude.rate_rpm = 0: must lie in [5, 200] rpm",
       "attitude.right_ascension: unknown", "attitude.model = 'tumbling': must be one of \"spin\"",
       "spin.sun_sensor.slit_cant_deg = 'steep': must be a number in [1, 89] deg",
       "faults.lost = 1.5: must lie in [0, 1]", "must not be below spoilt_min_s = 0.5",
       "faults.channel.sun3: unknown; did you mean sun", "truth.noise.sun_pulse_s = nan: must lie",
       "telemetry.kind = 'smoke': must be one of \"pulses\", \"coded\", \"both\""});
}

TEST(Scenario, RefusesWhatTheSchemaAloneCannotSee) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {kWhole + "[truth.ir.south]\nmount_angle_offset_deg = 10\n", "no error"},
      {replaced(kWhole, "mount_angle_deg = 95.0", "mount_angle_deg = 175.0") +
           "[truth.ir.south]\nmount_angle_offset_deg = 5\n",
       "truth.ir.south.mount_angle_offset_deg = 5: with spin.ir.south.mount_angle_deg = 175 must "
       "lie in (0, 180) deg"},
      {replaced(kWhole, "[spin.ir.south]\nmount_angle_deg = 95.0\nazimuth_deg = 92.0\n",
                "[truth.ir.south]\n"),
       "[truth.ir.south]: there is no [spin.ir.south]"},
      {replaced(kWhole, "rate_rpm = 60.0", "rate_rpm = 6.0\nrate_drift_rpm_h = -1000.0"),
       "the rate ends at 0.444 rpm: must lie in [5, 200] rpm"},
      {replaced(kWhole, "duration_s", "start_tai_ns = 1795143637000000000\nduration_s"),
       "pass: must have exactly one of start_utc, start_tai_ns, has 2"},
      {replaced(kWhole, "2026-11-20", "2126-11-20"),
       "pass.start_utc = \"2126-11-20T03:00:00Z\": must lie in [1972-01-01T"},
      {kWhole + "[faults]\nsilence = 3\n",
       "faults.silence = 3: must be an array of tables, [[faults.silence]]"},
      {kWhole + "[[faults.silence]]\nfrom_s = 3\nto_s = 2\n",
       "faults.silence[0].to_s = 2: must not be below from_s = 3"},
      {kWhole + "[[faults.silence]]\nfrom_s = 3\nto_s = 2\nwhy = 1\n",
       "faults.silence[0].why: unknown"}};
  for (const auto& [text, problem] : cases) {
    EXPECT_THAT(error_of(text), HasSubstr(problem));
  }
}

TEST(Scenario, RefusesAnOrbitFileThatEndsTooEarlyAndSaysByHowMuch) {
  const TemporaryFolder folder;
  const auto elements = loaded(replaced(kWhole, "duration_s = 20.0", "duration_s = 600.0"));
  ASSERT_TRUE(write_pass(folder.path(), elements, simulated_pass(elements).value()));
  // The orbit ends a day and a half after the pass.
  const std::string from_file = replaced(kWhole, kOrbit, "[orbit]\noem = \"orbit.oem\"\n");
  EXPECT_TRUE(load_scenario(folder.write("good.toml", from_file)));
  const auto late = load_scenario(
      folder.write("late.toml", replaced(from_file, "duration_s = 20.0", "duration_s = 130200.0")));
  EXPECT_THAT(late,
              IsRefused(ErrorCode::InvalidConfiguration,
                        AllOf(HasSubstr("late.toml:"),
                              HasSubstr("orbit.oem: must cover the pass and 30 s on both sides: "),
                              HasSubstr("30 s after the ephemeris ends"))));
  EXPECT_THAT(error_of(from_file), HasSubstr("orbit.oem = \"orbit.oem\": "));
}

TEST(Scenario, TakesTheOrbitFileOverAsItIs) {
  const TemporaryFolder folder;
  const auto gms5 = recorded_passes() / "gms5" / "orbit.oem";
  std::filesystem::copy(gms5, folder.path() / "gms5.oem");
  const std::string text = replaced(replaced(kWhole, kOrbit, "[orbit]\noem = \"gms5.oem\"\n"),
                                    "2026-11-20T03:00:00Z", "1996-02-17T23:30:00Z");
  const auto scenario = value_or_throw(load_scenario(folder.write("scenario.toml", text)));
  ASSERT_TRUE(write_pass(folder.path() / "pass", scenario, simulated_pass(scenario).value()));
  EXPECT_EQ(read_text_file(folder.path() / "pass" / "orbit.oem").value(),
            read_text_file(gms5).value());
}

/// Returns by how much the orbit file, written for another start, differs from the scenario's orbit
/// at equal times after the start, km.
double moved_by_km(const TemporaryFolder& folder, const std::string& text) {
  const auto path = folder.write("scenario.toml", text);
  const Scenario own = load_scenario(path).value();
  const TaiTime start = own.start + std::chrono::hours{24'000} + std::chrono::milliseconds{1};
  const Scenario moved = load_scenario(path, start).value();
  EXPECT_EQ(moved.start, start);
  EXPECT_TRUE(write_pass(folder.path() / "pass", moved, simulated_pass(moved).value()));
  const auto written = parse_oem(read_text_file(folder.path() / "pass" / "orbit.oem").value());
  double most_km = 0.0;
  for (double t_s = -30.0; t_s <= own.duration_s + 30.0; t_s += 1.0) {
    const auto was = own.orbit.at(shifted(own.start, t_s)).value();
    for (const auto& is : {moved.orbit.at(shifted(start, t_s)), written->at(shifted(start, t_s))}) {
      most_km = std::max(most_km, (is.value().position_icrf_km - was.position_icrf_km).norm());
    }
  }
  return most_km;
}

TEST(Scenario, MovesItsOrbitWithItsStart) {
  const TemporaryFolder folder;
  EXPECT_LT(moved_by_km(folder, kWhole), 1e-6);
  std::filesystem::copy(recorded_passes() / "gms5" / "orbit.oem", folder.path() / "gms5.oem");
  EXPECT_LT(moved_by_km(folder, replaced(replaced(kWhole, kOrbit, "[orbit]\noem = \"gms5.oem\"\n"),
                                         "2026-11-20T03:00:00Z", "1996-02-17T23:30:00Z")),
            1e-3);
}

TEST(Scenario, WritesTheOrbitOfThePassWhereItsFileGoesOnBehindAHole) {
  const TemporaryFolder folder;
  const Scenario elements = loaded(kWhole);
  const auto oem_of = [&](std::chrono::minutes from, std::chrono::minutes to) {
    const auto points = sampled_orbit(elements.orbit, elements.start + from, elements.start + to,
                                      std::chrono::seconds{60});
    return oem_text("SPINNER", elements.start, points.value());
  };
  const std::string first = oem_of(std::chrono::minutes{-10}, std::chrono::minutes{30});
  const std::string behind = oem_of(std::chrono::minutes{60}, std::chrono::minutes{90});
  folder.write("two.oem", first + "\n" + behind.substr(behind.find("META_START")));
  EXPECT_LT(moved_by_km(folder, replaced(kWhole, kOrbit, "[orbit]\noem = \"two.oem\"\n")), 1e-3);
}

TEST(Scenario, RefusesToSimulateBelowTheHorizon) {
  const auto scenario =
      loaded(replaced(replaced(kWhole, "a_km = 24400.0", "a_km = 6500.0"), "e = 0.73", "e = 0.0") +
             "[truth.horizon]\nco2_altitude_km = 200.0\n");
  EXPECT_THAT(simulated_pass(scenario),
              IsRefused(ErrorCode::InvalidConfiguration,
                        HasSubstr("must be above the infrared horizon, 6578.137 km")));
}

}  // namespace spindrift::testing::scenario_test
