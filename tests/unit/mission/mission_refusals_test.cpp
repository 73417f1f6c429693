#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "services/mission/mission.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/unit/mission/mission_texts.h"

namespace spindrift::mission_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

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
      {"three_axis.sun_sensor.misalignment_sigma_deg", {"1e-6", "90"}, {"9e-7", "91"}},
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

TEST(MissionRefusals, HoldsOrbitalElementsToTheirRanges) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> bad = {
      {"epoch_tai_ns", {"-1", "1.5e18"}},
      {"a_km", {"6378", "1000001", "nan"}},
      {"e", {"-0.1", "0.991", "1"}},
      {"i_deg", {"-1", "181"}},
      {"raan_deg", {"361"}},
      {"argp_deg", {"-361"}},
      {"mean_anomaly_deg", {"inf"}}};
  for (const auto& [key, values] : bad) {
    for (const char* value : values) {
      SCOPED_TRACE(std::string{key} + " = " + value);
      const auto toml = replaced(std::string{kElements}, "\n" + std::string{key} + " = .*",
                                 "\n" + std::string{key} + " = " + value);
      EXPECT_THAT(problems_of(toml), ElementsAre(HasSubstr(std::string{"orbit.elements."} + key)));
    }
    SCOPED_TRACE(key);
    EXPECT_THAT(
        problems_of(replaced(std::string{kElements}, "\n" + std::string{key} + " = .*", "")),
        ElementsAre(
            HasSubstr(std::string{"mission.toml:4: orbit.elements."} + key + ": missing: ")));
  }
}

TEST(MissionRefusals, WithAnOrbitInsideTheEarthIsRefused) {
  EXPECT_THAT(problems_of(replaced(std::string{kElements}, "e = 0.001", "e = 0.5")),
              ElementsAre(HasSubstr("mission.toml:4: [orbit.elements]: ")));
}

TEST(MissionRefusals, HasExactlyOneOrbit) {
  EXPECT_THAT(problems_of(replaced(std::string{kElements}, "\\[orbit.elements\\]",
                                   "[orbit]\noem = \"orbit.oem\"\n[orbit.elements]")),
              ElementsAre("mission.toml:4: orbit: must have exactly one of oem, elements, has 2"));
  EXPECT_THAT(problems_of(replaced(contract(), "oem = .*", "")),
              ElementsAre("mission.toml:4: orbit: must have exactly one of oem, elements, has 0"));
  EXPECT_THAT(problems_of(replaced(contract(), "oem = ", "ome = ")),
              ElementsAre("mission.toml:5: orbit.ome: unknown; did you mean oem?"));
}

TEST(MissionRefusals, OfASpinnerNeedsItsTables) {
  EXPECT_THAT(
      problems_of("[spacecraft]\nid = \"A\"\nkind = \"spin\"\n"),
      ElementsAre("mission.toml: [orbit]: missing: where it is",
                  "mission.toml: [spin.horizon]: missing: the infrared horizon of the Earth",
                  "mission.toml: [spin.noise]: missing: standard deviation of the time of an edge",
                  "mission.toml: [spin.sun_sensor]: missing: the two slits of the sun sensor"));
}

TEST(MissionRefusals, OfASpinnerMayHaveTheSunSensorAlone) {
  const auto mission = load(replaced(contract(), "\\[spin.ir.north\\][^@]*healthy[^\n]*", ""));
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_FALSE(mission->spin()->north);
  EXPECT_FALSE(mission->spin()->south);
}

TEST(MissionRefusals, NeedsASpacecraft) {
  EXPECT_THAT(problems_of(""),
              ElementsAre("mission.toml: [spacecraft]: missing: which spacecraft it is"));
  EXPECT_THAT(problems_of("[spacecraft]\n"),
              ElementsAre(HasSubstr("mission.toml:1: spacecraft.id: missing: text"),
                          HasSubstr("mission.toml:1: spacecraft.kind: missing: one of")));
}

TEST(MissionRefusals, HasItsEventsInOrder) {
  const auto at = [](const char* t1, const char* t2, const char* t3, const char* t4) {
    return std::string{
               "[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\nt1_tai_ns = "} +
           t1 + "\nt2_tai_ns = " + t2 + "\nt3_tai_ns = " + t3 + "\nt4_tai_ns = " + t4 + "\n";
  };
  EXPECT_THAT(problems_of(at("5", "5", "5", "5")), ElementsAre());
  EXPECT_THAT(problems_of(at("1", "2", "3", "4")), ElementsAre());
  EXPECT_THAT(
      problems_of(at("2", "1", "3", "4")),
      ElementsAre("mission.toml:6: reconstruction.t2_tai_ns = 1: must not be below t1_tai_ns = 2"));
  EXPECT_THAT(problems_of(at("4", "3", "2", "1")).size(), 3U);
  EXPECT_THAT(
      problems_of("[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\n"
                  "t1_tai_ns = 3\nt4_tai_ns = 2\n"),
      ElementsAre("mission.toml:6: reconstruction.t4_tai_ns = 2: must not be below t1_tai_ns = 3"));
  // The difference is 1 ns, which a double of this size cannot resolve.
  EXPECT_THAT(problems_of(at("1772337637000000000", "1772337637000000000", "1772337637000000001",
                             "1772337637000000000")),
              ElementsAre(HasSubstr("reconstruction.t4_tai_ns = 1772337637000000000: must not be "
                                    "below t3_tai_ns = 1772337637000000001")));
}

TEST(MissionRefusals, HasTheLaunchersChainWholeOrIsRefused) {
  const std::string start =
      "[spacecraft]\nid = \"A\"\nkind = \"three_axis\"\n[reconstruction]\nt1_tai_ns = 7\n"
      "[reconstruction.launcher]\neuler312_launch_deg = [1, 2, 3]\nsigma_deg = 0.5\n";
  EXPECT_THAT(problems_of(start + "site_lat_deg = 5\nsite_lon_deg = -52\nepoch_tai_ns = 4\n"),
              ElementsAre("mission.toml:6: reconstruction.launcher.launch_azimuth_deg: missing: "
                          "euler312_launch_deg needs it"));
  const auto mission = load(start +
                            "site_lat_deg = 5\nsite_lon_deg = -52\nepoch_tai_ns = 4\n"
                            "launch_azimuth_deg = 90\n");
  ASSERT_TRUE(mission) << mission.error().message;
  ASSERT_TRUE(mission->separation);
  EXPECT_EQ(mission->separation->times.separation, tai_from_ns(7));
  EXPECT_FALSE(mission->separation->times.control_on);
  ASSERT_TRUE(mission->separation->launcher);
  const auto& told = std::get<InLaunchFrame>(mission->separation->launcher->told);
  EXPECT_DOUBLE_EQ(told.launch.azimuth_rad, 90.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(told.angles.theta_rad, 2.0 * kRadPerDeg);
}

TEST(MissionRefusals, WithUnknownNamesIsRefused) {
  EXPECT_THAT(problems_of(std::string{kElements} + "[spni.noise]\nsun_pulse_s = 1\n"),
              ElementsAre("mission.toml:12: spni: unknown; did you mean spin?"));
  EXPECT_THAT(
      problems_of("colour = \"red\"\n" + std::string{kElements}),
      ElementsAre("mission.toml:1: colour: unknown; allowed here: alerts, archive, contact, "
                  "ground_model, orbit, reconstruction, sources, spacecraft, spin, three_axis"));
  EXPECT_THAT(problems_of(replaced(contract(), "\\[spin.noise\\]", "[spin.nose]")),
              ElementsAre(HasSubstr("spin.nose: unknown; did you mean noise?")));
}

TEST(MissionRefusals, WithAValueInPlaceOfATableIsRefused) {
  EXPECT_THAT(problems_of("spin = 3\n" + std::string{kElements}),
              ElementsAre("mission.toml:1: spin = 3: must be a table"));
  EXPECT_THAT(problems_of(std::string{kElements} + "[[spin.prior]]\nra_deg = 1\n"),
              ElementsAre(HasSubstr("mission.toml:12: spin.prior = ")));
  EXPECT_THAT(problems_of(std::string{kElements} + "[spacecraft.name]\n"),
              ElementsAre(HasSubstr("mission.toml:12: spacecraft.name: unknown")));
}

TEST(MissionRefusals, WithATableInPlaceOfAValueIsRefused) {
  EXPECT_THAT(
      problems_of(replaced(contract(), "slit_cant_deg = 45.0", "slit_cant_deg.value = 45.0")),
      ElementsAre(HasSubstr("spin.sun_sensor.slit_cant_deg = a table: must be a number in")));
}

TEST(MissionRefusals, ThatIsNoTomlIsRefusedWithLineAndColumn) {
  EXPECT_THAT(problems_of("[spacecraft]\nid = \"A\nkind"),
              ElementsAre(::testing::StartsWith("mission.toml:2:8: ")));
  EXPECT_THAT(problems_of("[spacecraft]\nid = \"A\"\nid = \"B\"\n"),
              ElementsAre(::testing::StartsWith("mission.toml:3:")));
  EXPECT_THAT(problems_of("\xff\xfe[spacecraft]"),
              ElementsAre(::testing::StartsWith("mission.toml:1:")));
}

TEST(MissionRefusals, ThatIsNotThereIsRefusedWithItsPath) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "none.toml";
  const auto none = load_mission(path);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::InvalidConfiguration);
  EXPECT_EQ(none.error().message, path.string() + ": cannot be read: No such file or directory");
  const auto directory = load_mission(folder.path());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().message,
            folder.path().string() + ": cannot be read: not a regular file");
}

TEST(MissionRefusals, WithABrokenOrbitFileIsRefusedNamingIt) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", "CCSDS_OEM_VERS = 2.0\nMETA_START\nrubbish\n");
  const auto mission = load_mission(folder.write("mission.toml", contract()));
  ASSERT_FALSE(mission);
  EXPECT_THAT(mission.error().message,
              AllOf(HasSubstr("mission.toml:5: orbit.oem = \"orbit.oem\": "),
                    ::testing::Not(HasSubstr("\n"))));
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
      EXPECT_TRUE(std::all_of(problem.begin(), problem.end(), [](char c) {
        return c >= ' ' && c <= '~';
      })) << problem;
    }
    EXPECT_FALSE(problems_of(toml).empty());
  }
}

TEST(MissionRefusals, ThatNestsTooDeepIsRefusedBeforeItIsParsed) {
  std::string deep = "[spacecraft]\n";
  for (int i = 0; i < 100'000; ++i) {
    deep += "a.";
  }
  EXPECT_THAT(problems_of(deep + "a = 1\n"),
              ElementsAre("mission.toml:2: tables and arrays must not stand deeper than 16 in each "
                          "other"));
}

TEST(MissionRefusals, WithAnOrbitFileOfOneEndlessLineIsRefusedByLine) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", "CCSDS_OEM_VERS = 2.0\nCOMMENT " + kEndless);
  const auto mission =
      load_mission(folder.write("mission.toml", text_of(kData / "mission" / "contract.toml")));
  ASSERT_FALSE(mission);
  EXPECT_THAT(mission.error().message, HasSubstr("line 2: must be 1024 bytes long at most"));
  EXPECT_LT(mission.error().message.size(), 1000U);
}

}  // namespace spindrift::mission_test
