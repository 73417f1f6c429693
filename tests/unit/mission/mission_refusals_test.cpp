#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/mission/mission.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/mission/mission_texts.h"

namespace spindrift::mission_test {

TEST(MissionRefusals, ReportsTenMistakesAsTenProblems) {
  EXPECT_THAT(
      problems_of(R"([spacecraft]
id = "A,B"
kind = "spin"
[orbit]
oem = "missing.oem"
[spin.sun_sensor]
slit_cant_deg = 95
slit_separation_dge = 35.0
[spin.ir.north]
mount_angle_deg = "85"
azimuth_deg = 90
[spin.screening]
window = 100.5
[spin.geometry]
determinant_ambiguous = 0.04
[spin.horizon]
model = "flat"
co2_altitude_km = 40
[three_axis.star_tracker]
q_body_sensor = [0.0, 0.0, 0.0, 2.0]
noise_arcsec = 20
)"),
      ElementsAre(
          "mission.toml:2: spacecraft.id = 'A,B': must be text, 1 to 32 printable ASCII "
          "characters, no comma, no space at an end",
          HasSubstr("mission.toml:5: orbit.oem = \"missing.oem\": "),
          "mission.toml:7: spin.sun_sensor.slit_cant_deg = 95: must lie in [1, 89] deg",
          "mission.toml:8: spin.sun_sensor.slit_separation_dge: unknown; did you mean "
          "slit_separation_deg?",
          "mission.toml:10: spin.ir.north.mount_angle_deg = '85': must be a number in [1, 179] deg",
          "mission.toml:13: spin.screening.window = 100.5: must be an integer in [3, 100000] "
          "revolutions",
          "mission.toml:15: spin.geometry.determinant_usable = 0.03: must not be below "
          "determinant_ambiguous = 0.04",
          "mission.toml:17: spin.horizon.model = 'flat': must be one of \"sphere\", \"ellipsoid\"",
          "mission.toml:20: three_axis.star_tracker.q_body_sensor = [ 0.0, 0.0, 0.0, 2.0 ]: must "
          "be an array of 4 numbers in [-1, 1], a quaternion of unit length",
          "mission.toml: [spin.noise]: missing: standard deviation of the time of an edge"));
}

TEST(MissionRefusals, TakeAFieldOfViewWholeOrNotAtAll) {
  const auto problems = [](const std::string& of_sun, const std::string& of_star) {
    return problems_of(fmt::format(R"([spacecraft]
id = "T"
kind = "three_axis"
[three_axis.gyro]
noise_deg_s = 0.002
bias_sigma_deg_s = 0.01
[three_axis.sun_sensor]
noise_deg = 0.5
{}
[three_axis.star_tracker]
q_body_sensor = [0.0, 0.0, 0.0, 1.0]
noise_arcsec = 20
{}
)",
                                   of_sun, of_star));
  };
  EXPECT_THAT(problems("boresight_body = [1.0, 0, 0]", "fov_deg = 20"),
              ElementsAre("mission.toml:9: three_axis.sun_sensor.boresight_body without "
                          "three_axis.sun_sensor.fov_deg: a field of view has both",
                          "mission.toml:13: three_axis.star_tracker.fov_deg without "
                          "three_axis.star_tracker.boresight_body: a field of view has both"));
  EXPECT_THAT(problems("", "boresight_body = [0, 0, 0]\nfov_deg = 20"),
              ElementsAre("mission.toml:13: three_axis.star_tracker.boresight_body = [0, 0, 0]: "
                          "must have a direction"));
}

TEST(MissionRefusals, TakeOneCommandedAttitudeOfUnitLength) {
  const auto problems = [](const std::string& keys) {
    return problems_of(std::string{kElements} + "[three_axis.nominal]\n" + keys);
  };
  EXPECT_THAT(problems("q_orbit_body = [0, 0, 0, 1]"), IsEmpty());
  EXPECT_THAT(problems(""), ElementsAre("mission.toml:12: three_axis.nominal: must have exactly "
                                        "one of q_orbit_body, q_icrf_body, has 0"));
  EXPECT_THAT(problems("q_orbit_body = [0, 0, 0, 1]\nq_icrf_body = [0, 0, 0, 1]"),
              ElementsAre("mission.toml:12: three_axis.nominal: must have exactly one of "
                          "q_orbit_body, q_icrf_body, has 2"));
  EXPECT_THAT(
      problems("q_icrf_body = [0, 0, 0.5, 0.5]"),
      ElementsAre(StartsWith("mission.toml:13: three_axis.nominal.q_icrf_body = [ 0, 0, 0.5, "
                             "0.5 ]: must be an array of 4 numbers in [-1, 1], a "
                             "quaternion of unit length")));
}

struct Range {
  const char* path;
  std::vector<const char*> good;
  std::vector<const char*> bad;
};

TEST(MissionRefusals, HoldsEveryKeyToItsRange) {
  const std::vector<Range> ranges = {
      {"spacecraft.id",
       {"'A'", "'A B'", "'12345678901234567890123456789012'"},
       {"''", "' A'", "'A '", "'A,B'", R"("A\nB")", "'é'", "'123456789012345678901234567890123'",
        "1"}},
      {"spacecraft.kind", {"'spin'", "'three_axis'"}, {"'Spin'", "''", "true"}},
      {"spin.sun_sensor.slit_cant_deg",
       {"1", "45", "89"},
       {"9e-299", "0", "0.99", "89.1", "89.99999999999999", "-45", "nan", "'45'"}},
      {"spin.sun_sensor.slit_separation_deg", {"-179.9", "0", "179.9"}, {"-180", "180", "inf"}},
      {"spin.ir.north.mount_angle_deg", {"1", "179"}, {"1e-308", "0", "0.9", "179.1", "-inf"}},
      {"spin.ir.north.azimuth_deg", {"-360", "360"}, {"-360.1", "360.1"}},
      {"spin.ir.north.healthy", {"true", "false"}, {"1", "'true'"}},
      {"spin.noise.sun_pulse_s", {"1e-9", "1"}, {"0", "9e-10", "-1e-4", "1.1"}},
      {"spin.noise.ir_pulse_s", {"1e-9", "1"}, {"0", "9e-10", "-1e-4", "1.1"}},
      {"spin.horizon.model", {"'sphere'", "'ellipsoid'"}, {"'wgs84'", "3"}},
      {"spin.horizon.co2_altitude_km", {"0", "200"}, {"-0.1", "200.1"}},
      {"spin.screening.window", {"3", "100000"}, {"2", "100001", "100.0", "inf"}},
      {"spin.screening.sigma", {"0.1", "100"}, {"0", "0.09", "100.1"}},
      {"spin.screening.interference_s", {"0", "1"}, {"-1e-9", "1.1"}},
      {"spin.geometry.determinant_usable", {"0.01", "1"}, {"0.009", "1.1"}},
      {"spin.geometry.determinant_ambiguous", {"0", "0.03"}, {"-0.01", "0.031"}},
      {"spin.prior.ra_deg", {"-360", "360"}, {"361", "-361"}},
      {"spin.prior.dec_deg", {"-90", "90"}, {"-90.1", "90.1"}},
      {"spin.prior.sigma_deg", {"0.001", "180"}, {"0", "1e-300", "181"}},
      {"three_axis.gyro.noise_deg_s", {"1e-9", "360"}, {"1e-300", "361"}},
      {"three_axis.gyro.bias_sigma_deg_s", {"1e-9", "360"}, {"1e-300", "361"}},
      {"three_axis.sun_sensor.noise_deg", {"1e-6", "90"}, {"9e-7", "91"}},
      {"three_axis.star_tracker.q_body_sensor",
       {"[1, 0, 0, 0]", "[0.5, -0.5, 0.5, -0.5]", "[0.7071, 0, 0, 0.7071]"},
       {"[0, 0, 1]", "[0, 0, 0, 0]", "[0, 0, 0, 0, 1]", "[0, 0, 0, nan]", "[0, 0, 0, '1']", "1",
        "[[0, 0, 0, 1]]", "[0.707, 0, 0, 0.707]", "[]", "[0, 0, 0, [1]]"}},
      {"three_axis.star_tracker.noise_arcsec", {"1e-3", "36000"}, {"9e-4", "36001"}},
      {"three_axis.magnetometer.noise_nt", {"1e-3", "100000"}, {"9e-4", "100001"}},
      {"three_axis.inertia.kg_m2",
       {"[[2, 0.1, 0], [0.1, 2, 0], [0, 0, 2]]", "[[1, 0, 0], [0, 1, 0], [0, 0, 2]]"},
       {"[[1, 0, 0], [0, 1, 0], [0, 0, 2.1]]", "[[2, 0.1, 0], [0, 2, 0], [0, 0, 2]]",
        "[[2, 0, 0], [0, -2, 0], [0, 0, 2]]", "[[0, 0, 0], [0, 0, 0], [0, 0, 0]]", "[2, 2, 2]",
        "[[2, 0, 0], [0, 2, 0]]", "[[2, 0], [0, 2], [0, 0]]",
        "[[2, 0, 0], [0, 2, 0], [0, 0, inf]]"}},
      {"three_axis.inertia.sigma_fraction", {"0", "0.99"}, {"-0.1", "1"}},
      {"spin.alignment.slit_cant_deg", {"0", "10"}, {"-0.05", "10.1", "nan", "'0.05'"}},
      {"spin.alignment.slit_separation_deg", {"0", "10"}, {"-0.05", "10.1"}},
      {"spin.alignment.north_mount_angle_deg", {"0", "10"}, {"-0.05", "10.1"}},
      {"spin.alignment.south_mount_angle_deg", {"0", "10"}, {"-0.05", "10.1"}},
      {"spin.alignment.north_azimuth_deg", {"0", "10"}, {"-0.05", "10.1"}},
      {"spin.alignment.south_azimuth_deg", {"0", "10"}, {"-0.05", "10.1"}},
      {"spin.alignment.co2_altitude_km", {"0", "50"}, {"-1", "51", "inf"}},
      {"spin.alignment.time_tag_s", {"0", "10"}, {"-1", "11"}},
      {"three_axis.alignment.star_tracker_deg", {"0", "10"}, {"-0.01", "10.1"}},
      {"three_axis.alignment.sun_sensor_deg", {"0", "10"}, {"-0.01", "10.1"}},
      {"three_axis.alignment.magnetometer_deg", {"0", "10"}, {"-0.01", "10.1"}},
      {"three_axis.alignment.magnetometer_bias_nt", {"0", "100000"}, {"-1", "100001"}},
      {"three_axis.alignment.gyro_scale", {"0", "0.99"}, {"-0.001", "1"}},
      {"three_axis.alignment.gyro_deg", {"0", "10"}, {"-0.01", "10.1"}},
      {"three_axis.alignment.time_tag_s", {"0", "10"}, {"-0.01", "10.1"}},
      {"three_axis.alignment.inertia_fraction", {"0", "0.99"}, {"-0.01", "1"}},
      {"reconstruction.t1_tai_ns", {"0"}, {"-1", "0.0", "'2026-11-20'", "2026-11-20"}},
      {"reconstruction.t4_tai_ns", {"4102444800000000000"}, {"4102444800000000001"}},
      {"reconstruction.launcher.euler312_deg", {"[-360, 0, 360]"}, {"[0, 0]", "[0, 0, 361]"}},
      {"reconstruction.disturbance_deg_s2", {"0", "1"}, {"-1e-9", "1.1"}},
      {"reconstruction.launcher.sigma_deg", {"0.001", "180"}, {"0", "181", "inf", "nan"}},
      {"spin.target.ra_deg", {"-360", "360"}, {"361", "-361"}},
      {"spin.target.dec_deg", {"-90", "90"}, {"-90.1", "90.1"}},
      {"spin.target.rpm", {"0.1", "1000"}, {"0", "1001"}},
      {"spin.target.tolerance_rpm", {"1e-6", "1000"}, {"0", "1001"}},
      {"contact.aos_utc",
       {"'2026-11-20T03:00:00Z'"},
       {"'2026-11-20 03:00'", "'2026-11-20T03:00:00'", "'soon'", "3"}},
      {"contact.los_utc", {"'2026-11-20T03:10:00.5Z'"}, {"''", "true"}},
  };
  for (const Range& range : ranges) {
    SCOPED_TRACE(range.path);
    for (const char* value : range.good) {
      EXPECT_THAT(problems_of(contract_with(range.path, value)), ElementsAre()) << value;
    }
    for (const char* value : range.bad) {
      EXPECT_THAT(problems_of(contract_with(range.path, value)), ElementsAre(HasSubstr(": must ")))
          << value;
    }
  }
}

/// Returns the mission with orbital elements with the only match of `pattern` replaced.
std::string elements(const std::string& pattern, const std::string& by) {
  return replaced(std::string{kElements}, pattern, by);
}

TEST(MissionRefusals, HoldsOrbitalElementsToTheirRanges) {
  const std::vector<std::pair<std::string, std::vector<const char*>>> bad = {
      {"epoch_tai_ns", {"-1", "1.5e18"}},
      {"a_km", {"6378", "1000001", "nan"}},
      {"e", {"-0.1", "0.991", "1"}},
      {"i_deg", {"-1", "181"}},
      {"raan_deg", {"361"}},
      {"argp_deg", {"-361"}},
      {"mean_anomaly_deg", {"inf"}}};
  for (const auto& [key, values] : bad) {
    SCOPED_TRACE(key);
    const std::string line = "\n" + key + " = ";
    for (const char* value : values) {
      EXPECT_THAT(problems_of(elements(line + ".*", line + value)),
                  ElementsAre(HasSubstr("orbit.elements." + key)))
          << value;
    }
    EXPECT_THAT(problems_of(elements(line + ".*", "")),
                ElementsAre(HasSubstr("mission.toml:4: orbit.elements." + key + ": missing: ")));
  }
}

std::string with_events(const char* t1, const char* t2, const char* t3, const char* t4) {
  return std::string{
             "[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\nt1_tai_ns = "} +
         t1 + "\nt2_tai_ns = " + t2 + "\nt3_tai_ns = " + t3 + "\nt4_tai_ns = " + t4 + "\n";
}

const std::string kLaunched =
    "[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\nt1_tai_ns = 7\n"
    "[reconstruction.launcher]\neuler312_launch_deg = [1, 2, 3]\nsigma_deg = 0.5\n"
    "site_lat_deg = 5\nsite_lon_deg = -52\nepoch_tai_ns = 4\n";

/// What a mission file is refused for: its problems, a line each, and how many they are.
struct Refusal {
  std::string toml;
  ::testing::Matcher<std::string> problems;
  std::size_t count = 1;
};

const std::string kLeo{kElements};

std::vector<Refusal> refusals() {
  return {
      {elements("e = 0.001", "e = 0.5"), HasSubstr("mission.toml:4: [orbit.elements]: ")},
      {elements("\\[orbit.elements\\]", "[orbit]\noem = \"orbit.oem\"\n[orbit.elements]"),
       "mission.toml:4: orbit: must have exactly one of oem, elements, has 2"},
      {replaced(contract(), "oem = .*", ""),
       "mission.toml:4: orbit: must have exactly one of oem, elements, has 0"},
      {replaced(contract(), "oem = ", "ome = "),
       "mission.toml:5: orbit.ome: unknown; did you mean oem?"},
      {"[spacecraft]\nid = \"A\"\nkind = \"spin\"\n",
       "mission.toml: [orbit]: missing: where it is\n"
       "mission.toml: [spin.horizon]: missing: the infrared horizon of the Earth\n"
       "mission.toml: [spin.noise]: missing: standard deviation of the time of an edge\n"
       "mission.toml: [spin.sun_sensor]: missing: the two slits of the sun sensor",
       4},
      {"", "mission.toml: [spacecraft]: missing: which spacecraft it is"},
      {"[spacecraft]\n",
       AllOf(HasSubstr("mission.toml:1: spacecraft.id: missing: text"),
             HasSubstr("mission.toml:1: spacecraft.kind: missing: one of")),
       2},
      {with_events("5", "5", "5", "5"), "", 0},
      {with_events("1", "2", "3", "4"), "", 0},
      {with_events("2", "1", "3", "4"),
       "mission.toml:6: reconstruction.t2_tai_ns = 1: must not be below t1_tai_ns = 2"},
      {with_events("4", "3", "2", "1"), _, 3},
      {"[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\n"
       "t1_tai_ns = 3\nt4_tai_ns = 2\n",
       "mission.toml:6: reconstruction.t4_tai_ns = 2: must not be below t1_tai_ns = 3"},
      // The difference is 1 ns, which a double of this size cannot resolve.
      {with_events("1772337637000000000", "1772337637000000000", "1772337637000000001",
                   "1772337637000000000"),
       HasSubstr("reconstruction.t4_tai_ns = 1772337637000000000: must not be below t3_tai_ns = "
                 "1772337637000000001")},
      {kLaunched,
       "mission.toml:6: reconstruction.launcher.launch_azimuth_deg: missing: euler312_launch_deg "
       "needs it"},
      {kLeo + "[alerts.before_aos]\n\"attitude.doubtful\" = { seconds = 60.0 }\n",
       "mission.toml:12: alerts.before_aos: needs [contact], whose times it refers to"},
      {kLeo + "[alerts.after_los]\n\"link.silent\" = { seconds = 60.0 }\n",
       HasSubstr("mission.toml:13: alerts.after_los.link.silent: unknown")},
      {kLeo + "[spni.noise]\nsun_pulse_s = 1\n",
       "mission.toml:12: spni: unknown; did you mean spin?"},
      {"colour = \"red\"\n" + kLeo,
       "mission.toml:1: colour: unknown; allowed here: alerts, archive, calibration, contact, "
       "ground_model, orbit, reconstruction, sources, spacecraft, spin, three_axis, time"},
      {replaced(contract(), "\\[spin.noise\\]", "[spin.nose]"),
       HasSubstr("spin.nose: unknown; did you mean noise?")},
      {"spin = 3\n" + kLeo, "mission.toml:1: spin = 3: must be a table"},
      {kLeo + "[[spin.prior]]\nra_deg = 1\n", HasSubstr("mission.toml:12: spin.prior = ")},
      {kLeo + "[spacecraft.name]\n", HasSubstr("mission.toml:12: spacecraft.name: unknown")},
      {replaced(contract(), "slit_cant_deg = 45.0", "slit_cant_deg.value = 45.0"),
       HasSubstr("spin.sun_sensor.slit_cant_deg = a table: must be a number in")},
      {"[spacecraft]\nid = \"A\nkind", StartsWith("mission.toml:2:8: ")},
      {"[spacecraft]\nid = \"A\"\nid = \"B\"\n", StartsWith("mission.toml:3:")},
      {"\xff\xfe[spacecraft]", StartsWith("mission.toml:1:")},
      {replaced(contract(), "T03:10:00Z", "T03:00:00Z"), HasSubstr("must be later than aos_utc")},
      {"[spacecraft]\n" + times(100'000, "a.") + "a = 1\n",
       "mission.toml:2: tables and arrays must not stand deeper than 16 in each other"}};
}

TEST(MissionRefusals, SaysLineKeyAndWhatMustBe) {
  for (const auto& [toml, expected, count] : refusals()) {
    SCOPED_TRACE(::testing::DescribeMatcher<std::string>(expected));
    const std::vector<std::string> problems = problems_of(toml);
    EXPECT_THAT(problems, SizeIs(count));
    EXPECT_THAT(fmt::format("{}", fmt::join(problems, "\n")), expected);
  }
}

TEST(MissionRefusals, OfASpinnerMayHaveTheSunSensorAlone) {
  const auto mission =
      value_or_throw(load(replaced(contract(), "\\[spin.ir.north\\][^@]*healthy[^\n]*", "")));
  EXPECT_FALSE(mission.spin()->north);
  EXPECT_FALSE(mission.spin()->south);
}

TEST(MissionRefusals, TakesTheLaunchersChainWhole) {
  const auto mission = value_or_throw(load(kLaunched + "launch_azimuth_deg = 90\n"));
  EXPECT_EQ(mission.separation.value().times.separation, tai_from_ns(7));
  EXPECT_FALSE(mission.separation->times.control_on);
  const auto& told = std::get<InLaunchFrame>(mission.separation->launcher.value().told);
  EXPECT_DOUBLE_EQ(told.launch.azimuth_rad, 90.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(told.angles.theta_rad, 2.0 * kRadPerDeg);
}

TEST(MissionRefusals, ThatIsNotThereIsRefusedWithItsPath) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "none.toml";
  EXPECT_THAT(load_mission(path),
              IsRefused(ErrorCode::InvalidConfiguration,
                        path.string() + ": cannot be read: No such file or directory"));
  EXPECT_THAT(load_mission(folder.path()),
              IsRefused(ErrorCode::InvalidConfiguration,
                        folder.path().string() + ": cannot be read: not a regular file"));
}

/// Returns the refusal of the contract's mission with this orbit file.
std::string refusal_with_orbit(const std::string& oem) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", oem);
  const auto mission = load_mission(folder.write("mission.toml", contract()));
  return mission ? "accepted" : mission.error().message;
}

const std::string kEndless(100'000, 'x');

TEST(MissionRefusals, IsRefusedWithItsTextEscapedAndCut) {
  const std::string quotes(100'000, '"');
  for (const std::string& toml :
       {std::string{"[spacecraft]\n\"k\\u001b[2J\" = 1\n"}, std::string{"\"\\u009b2J\" = 1\n"},
        std::string{"[spacecraft]\nid = \"A\\u001b[2J\"\n"},
        std::string{"[spacecraft]\nid = \"\"\"A\n\\u0007\"\"\"\n"},
        std::string{"[orbit]\noem = \"\\u001b[2J.oem\"\n"}, std::string{"a = \x1b\n"},
        std::string{"[\"\\u001b\"]\n[\"\\u001b\"]\n"}, std::string{"\xff = 1\n"},
        "\"" + kEndless + "\" = 1\n", "id = \"" + kEndless + "\"\n",
        "[spacecraft]\nid = [" + quotes + "]\n"}) {
    for (const std::string& problem : problems_of(toml)) {
      EXPECT_LT(problem.size(), 1000U) << problem;
      EXPECT_TRUE(std::ranges::all_of(problem, [](char c) { return c >= ' ' && c <= '~'; }))
          << problem;
    }
    EXPECT_FALSE(problems_of(toml).empty());
  }
}

TEST(MissionRefusals, WithABrokenOrbitFileIsRefusedNamingItOrItsLine) {
  EXPECT_THAT(
      refusal_with_orbit("CCSDS_OEM_VERS = 2.0\nMETA_START\nrubbish\n"),
      AllOf(HasSubstr("mission.toml:5: orbit.oem = \"orbit.oem\": "), Not(HasSubstr("\n"))));
  const std::string endless = refusal_with_orbit("CCSDS_OEM_VERS = 2.0\nCOMMENT " + kEndless);
  EXPECT_THAT(endless, HasSubstr("line 2: must be 1024 bytes long at most"));
  EXPECT_LT(endless.size(), 1000U);
}

}  // namespace spindrift::mission_test
