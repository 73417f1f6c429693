#include "services/mission/mission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/frames/angle.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"

namespace spindrift::mission_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::filesystem::path kData = test_data();

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// Loads a text as mission.toml beside an orbit.oem.
Expected<Mission> load(std::string_view toml) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", text_of(kData / "mission" / "orbit.oem"));
  return load_mission(folder.write("mission.toml", toml));
}

/// One string a problem, without the folder; empty when there is none.
std::vector<std::string> problems_of(std::string_view toml) {
  const auto mission = load(toml);
  if (mission) {
    return {};
  }
  EXPECT_EQ(mission.error().code, ErrorCode::InvalidConfiguration);
  std::istringstream message{mission.error().message};
  std::vector<std::string> problems;
  for (std::string line; std::getline(message, line);) {
    problems.push_back(line.substr(line.find("mission.toml")));
  }
  return problems;
}

std::string contract() { return text_of(kData / "mission" / "contract.toml"); }

/// `toml` with the one place where `pattern` stands replaced.
std::string replaced(const std::string& toml, const std::string& pattern, const std::string& by) {
  const std::regex regex{pattern};
  EXPECT_TRUE(std::regex_search(toml, regex)) << pattern;
  return std::regex_replace(toml, regex, by, std::regex_constants::format_first_only);
}

/// The contract's example with one value set, lines lost.
std::string contract_with(const std::string& path, const std::string& value) {
  toml::table document = toml::parse(contract());
  const auto dot = path.rfind('.');
  toml::table& table = *document.at_path(path.substr(0, dot)).as_table();
  table.insert_or_assign(path.substr(dot + 1), *toml::parse("v = " + value).get("v"));
  std::ostringstream out;
  out << document;
  return out.str();
}

constexpr std::string_view kElements = R"([spacecraft]
id = "LEO"
kind = "three_axis"
[orbit.elements]
epoch_tai_ns = 1795143637000000000
a_km = 7000
e = 0.001
i_deg = 98.0
raan_deg = 10.0
argp_deg = 20.0
mean_anomaly_deg = 30.0
)";

TEST(Mission, GivesASpinnerAsTheContractDescribesIt) {
  const auto mission = load(contract());
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->spacecraft_id, "SPINNER");
  EXPECT_EQ(mission->kind(), SpacecraftKind::Spin);
  EXPECT_TRUE(mission->orbit);
  ASSERT_TRUE(mission->spin());
  const SpinConfig& spin = *mission->spin();
  EXPECT_DOUBLE_EQ(spin.sun_sensor.slit_cant_rad, 45.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.sun_sensor.slit_separation_rad, 35.0 * kRadPerDeg);
  ASSERT_TRUE(spin.north);
  EXPECT_DOUBLE_EQ(spin.north->mount_angle_rad, 85.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.north->azimuth_rad, 90.0 * kRadPerDeg);
  EXPECT_FALSE(spin.north->healthy);
  EXPECT_FALSE(spin.south);
  EXPECT_EQ(spin.noise.sun_s, 1.0e-4);
  EXPECT_EQ(spin.noise.infrared_s, 5.0e-4);
  EXPECT_EQ(spin.horizon.model, HorizonModel::Sphere);
  EXPECT_EQ(spin.horizon.co2_altitude_km, 40.0);
  ASSERT_TRUE(spin.prior);
  // Right ascension 100 deg, declination -55 deg.
  EXPECT_NEAR(spin.prior->axis_icrf.x(), -0.0996005, 1e-7);
  EXPECT_NEAR(spin.prior->axis_icrf.y(), 0.5648625, 1e-7);
  EXPECT_NEAR(spin.prior->axis_icrf.z(), -0.8191520, 1e-7);
  EXPECT_DOUBLE_EQ(spin.prior->sigma_rad, 5.0 * kRadPerDeg);
}

TEST(Mission, KeepsEveryOptionalValueThatIsGiven) {
  auto toml = contract();
  toml = replaced(toml, "healthy = false", "healthy = true");
  toml = replaced(toml, "\"sphere\"", "\"ellipsoid\"");
  toml = replaced(toml, "window = 100", "window = 50");
  toml = replaced(toml, "sigma = 3.0", "sigma = 4");
  toml = replaced(toml, "interference_s = 0.0", "interference_s = 0.001");
  toml = replaced(toml, "usable = 0.03", "usable = 0.05");
  toml = replaced(toml, "ambiguous = 0.01", "ambiguous = 0.02");
  toml += "[spin.ir.south]\nmount_angle_deg = 95\nazimuth_deg = -92\n";
  const auto mission = load(toml);
  ASSERT_TRUE(mission) << mission.error().message;
  const SpinConfig& spin = *mission->spin();
  EXPECT_TRUE(spin.north->healthy);
  ASSERT_TRUE(spin.south);
  EXPECT_DOUBLE_EQ(spin.south->mount_angle_rad, 95.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(spin.south->azimuth_rad, -92.0 * kRadPerDeg);
  EXPECT_FALSE(spin.south->healthy);
  EXPECT_EQ(spin.horizon.model, HorizonModel::Ellipsoid);
  EXPECT_EQ(spin.screening.window, 50);
  EXPECT_EQ(spin.screening.sigma, 4.0);
  EXPECT_EQ(spin.screening.interference_s, 0.001);
  EXPECT_EQ(spin.geometry.determinant_usable, 0.05);
  EXPECT_EQ(spin.geometry.determinant_ambiguous, 0.02);
}

TEST(Mission, HasTheDefaultsOfThePipelineWhereTheFileIsSilent) {
  const auto mission = load_mission(kData / "spin" / "nominal" / "mission.toml");
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->spin()->screening.window, SpinScreening{}.window);
  EXPECT_EQ(mission->spin()->screening.sigma, SpinScreening{}.sigma);
  EXPECT_EQ(mission->spin()->screening.interference_s, SpinScreening{}.interference_s);
  EXPECT_EQ(mission->spin()->geometry.determinant_usable, SpinGeometry{}.determinant_usable);
  EXPECT_EQ(mission->spin()->geometry.determinant_ambiguous, SpinGeometry{}.determinant_ambiguous);
  EXPECT_FALSE(mission->spin()->prior);
}

TEST(Mission, HasLimitsOfAlertsAndATargetWhereTheFileGivesThem) {
  const auto contract_mission = load(contract());
  ASSERT_TRUE(contract_mission);
  EXPECT_EQ(contract_mission->alerts.ambiguous_s, AlertLimits{}.ambiguous_s);
  EXPECT_EQ(contract_mission->alerts.rejection.revolutions, AlertLimits{}.rejection.revolutions);
  ASSERT_TRUE(contract_mission->target);
  EXPECT_NEAR(contract_mission->target->axis_icrf.z(), std::sin(-55.0 * kRadPerDeg), 1e-15);
  ASSERT_TRUE(contract_mission->target->rate);
  EXPECT_NEAR(contract_mission->target->rate->rad_s, 6.283185307179586, 1e-12);
  const auto given =
      load(replaced(contract(), "\"spin.sigma\" = .*", "\"spin.ambiguous\" = { seconds = 7.0 }"));
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->alerts.ambiguous_s, 7.0);
}

TEST(Mission, OfAThreeAxisSpacecraftHasNoSpin) {
  const auto mission = load(replaced(contract(), "kind = \"spin\"", "kind = \"three_axis\""));
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->kind(), SpacecraftKind::ThreeAxis);
  EXPECT_FALSE(mission->spin());
  EXPECT_TRUE(mission->orbit);
}

TEST(Mission, OfAThreeAxisSpacecraftHasItsSensorsAndInertia) {
  const auto mission = load(replaced(contract(), "kind = \"spin\"", "kind = \"three_axis\""));
  ASSERT_TRUE(mission) << mission.error().message;
  const auto& config = std::get<ThreeAxisConfig>(mission->config);
  ASSERT_TRUE(config.gyro && config.sun_sensor && config.star_tracker && config.magnetometer);
  EXPECT_DOUBLE_EQ(config.gyro->noise_rad_s, 0.002 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.gyro->bias_sigma_rad_s, 0.01 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.gyro->range_rad_s.value(), 100.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.sun_sensor->noise_rad, 0.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(config.star_tracker->noise_rad, 20.0 / 3600.0 * kRadPerDeg);
  EXPECT_EQ(config.star_tracker->q_body_sensor.w(), 1.0);
  EXPECT_EQ(config.magnetometer->noise_nt, 100.0);
  ASSERT_TRUE(config.inertia);
  EXPECT_EQ(config.inertia->kg_m2.diagonal(), Eigen::Vector3d(120.0, 100.0, 140.0));
  EXPECT_EQ(config.inertia->sigma_fraction, 0.0);
}

TEST(Mission, KeepsTheOrderOfTheQuaternionThatTheFileHas) {
  const auto mission = load_mission(kData / "mission" / "separation.toml");
  ASSERT_TRUE(mission) << mission.error().message;
  const auto& tracker = std::get<ThreeAxisConfig>(mission->config).star_tracker;
  ASSERT_TRUE(tracker);
  EXPECT_NEAR(tracker->q_body_sensor.x(), 0.191688957157693, 1e-12);
  EXPECT_NEAR(tracker->q_body_sensor.w(), 0.876384251986657, 1e-12);
}

TEST(Mission, OfAThreeAxisSpacecraftMayHaveNoOrbit) {
  const auto mission = load_mission(kData / "mission" / "juno.toml");
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->spacecraft_id, "juno");
  EXPECT_FALSE(mission->orbit);
}

TEST(Mission, IsReadFromEveryFileThatWeHave) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{kData}) {
    const auto folder = entry.path().parent_path().filename();
    if (entry.path().filename() == "mission.toml" ||
        (folder == "mission" && entry.path().extension() == ".toml")) {
      SCOPED_TRACE(entry.path());
      const auto mission = load_mission(entry.path());
      ASSERT_TRUE(mission) << mission.error().message;
      for (const std::string& doubt : mission->orbit_doubts) {
        EXPECT_THAT(doubt, Not(HasSubstr("jumps")));
      }
      ++count;
    }
  }
  EXPECT_GE(count, 6);
}

TEST(Mission, KeepsItsTextAndTheDigestOfIt) {
  const auto mission = load(kElements);
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->toml_text, kElements);
  EXPECT_EQ(mission->sha256, "93982e46ee9573e317a20ad5691cd557a7bef3767e635b3b7261c7bd8bcd5d08");
}

TEST(Mission, TakesItsOrbitFromElements) {
  const auto mission = load(kElements);
  ASSERT_TRUE(mission) << mission.error().message;
  ASSERT_TRUE(mission->orbit);
  EXPECT_FALSE(mission->orbit_sha256);
  const auto state = mission->orbit->at(tai_from_ns(1795143637000000000));
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->position_icrf_km.norm(), 7000.0, 7000.0 * 0.001);
  // Inclination: the orbit normal from the pole.
  const auto normal = state->position_icrf_km.cross(state->velocity_icrf_km_s).normalized();
  EXPECT_NEAR(normal.z(), std::cos(98.0 * kRadPerDeg), 1e-12);
}

TEST(Mission, FindsItsOrbitBesideIt) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "orbits");
  folder.write("orbits/a.oem", text_of(kData / "mission" / "orbit.oem"));
  const auto path = folder.write(
      "mission.toml",
      "spacecraft = {id = \"A\", kind = \"three_axis\"}\norbit.oem = \"orbits/a.oem\"");
  const auto mission = load_mission(path);
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_TRUE(mission->orbit);
  // By sha256sum.
  EXPECT_EQ(mission->orbit_sha256,
            "fa12bab2701921c14d404592742de10c1b9252419573b8ee588436c30390c9c1");
}

/// Of the contract's mission under another name. The orbit is that of LEOSAT, 2026-999A.
std::vector<std::string> orbit_doubts_of(const char* spacecraft) {
  return load(contract_with("spacecraft.id", spacecraft)).value().orbit_doubts;
}

TEST(Mission, DoubtsAnOrbitUnderTheNameOfAnother) {
  EXPECT_THAT(orbit_doubts_of("'SPINNER'"),
              ElementsAre("the orbit file says OBJECT_NAME = LEOSAT, OBJECT_ID = 2026-999A, the "
                          "mission file spacecraft.id = \"SPINNER\""));
  EXPECT_THAT(orbit_doubts_of("'LEOSAT'"), IsEmpty());
  EXPECT_THAT(orbit_doubts_of("'2026-999A'"), IsEmpty());
  EXPECT_THAT(load(kElements).value().orbit_doubts, IsEmpty());
}

TEST(Mission, DoubtsAnOrbitThatJumps) {
  const TemporaryFolder folder;
  const std::string orbit = text_of(kData / "mission" / "orbit.oem");
  folder.write("orbit.oem", replaced(orbit, "6468\\.015605479", "6453.015605479"));
  const auto mission =
      load_mission(folder.write("mission.toml", contract_with("spacecraft.id", "'LEOSAT'")));
  ASSERT_TRUE(mission) << mission.error().message;
  // 7037 km from the Earth's centre.
  EXPECT_THAT(
      mission->orbit_doubts,
      ElementsAre(AllOf(
          HasSubstr("orbit.oem = \"orbit.oem\", line 33: the orbit jumps by 15 km at "
                    "2026-03-01T04:06:00.000Z, the first of 2 such steps: states of different"),
          HasSubstr("off by up to 0.12 deg there"))));
}

TEST(Mission, ReportsTenMistakesAsTenProblems) {
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

TEST(Mission, HoldsEveryKeyToItsRange) {
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
      {"contact.aos_utc", {"'2026-11-20T03:00:00Z'"}, {"'2026-11-20 03:00'", "'soon'", "3"}},
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

TEST(Mission, HoldsOrbitalElementsToTheirRanges) {
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

TEST(Mission, WithAnOrbitInsideTheEarthIsRefused) {
  EXPECT_THAT(problems_of(replaced(std::string{kElements}, "e = 0.001", "e = 0.5")),
              ElementsAre(HasSubstr("mission.toml:4: [orbit.elements]: ")));
}

TEST(Mission, HasExactlyOneOrbit) {
  EXPECT_THAT(problems_of(replaced(std::string{kElements}, "\\[orbit.elements\\]",
                                   "[orbit]\noem = \"orbit.oem\"\n[orbit.elements]")),
              ElementsAre("mission.toml:4: orbit: must have exactly one of oem, elements, has 2"));
  EXPECT_THAT(problems_of(replaced(contract(), "oem = .*", "")),
              ElementsAre("mission.toml:4: orbit: must have exactly one of oem, elements, has 0"));
  EXPECT_THAT(problems_of(replaced(contract(), "oem = ", "ome = ")),
              ElementsAre("mission.toml:5: orbit.ome: unknown; did you mean oem?"));
}

TEST(Mission, OfASpinnerNeedsItsTables) {
  EXPECT_THAT(
      problems_of("[spacecraft]\nid = \"A\"\nkind = \"spin\"\n"),
      ElementsAre("mission.toml: [orbit]: missing: where it is",
                  "mission.toml: [spin.horizon]: missing: the infrared horizon of the Earth",
                  "mission.toml: [spin.noise]: missing: standard deviation of the time of an edge",
                  "mission.toml: [spin.sun_sensor]: missing: the two slits of the sun sensor"));
}

TEST(Mission, OfASpinnerMayHaveTheSunSensorAlone) {
  const auto mission = load(replaced(contract(), "\\[spin.ir.north\\][^@]*healthy[^\n]*", ""));
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_FALSE(mission->spin()->north);
  EXPECT_FALSE(mission->spin()->south);
}

TEST(Mission, NeedsASpacecraft) {
  EXPECT_THAT(problems_of(""),
              ElementsAre("mission.toml: [spacecraft]: missing: which spacecraft it is"));
  EXPECT_THAT(problems_of("[spacecraft]\n"),
              ElementsAre(HasSubstr("mission.toml:1: spacecraft.id: missing: text"),
                          HasSubstr("mission.toml:1: spacecraft.kind: missing: one of")));
}

TEST(Mission, HasItsEventsInOrder) {
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
  // One nanosecond, which a double of this size cannot hold.
  EXPECT_THAT(problems_of(at("1772337637000000000", "1772337637000000000", "1772337637000000001",
                             "1772337637000000000")),
              ElementsAre(HasSubstr("reconstruction.t4_tai_ns = 1772337637000000000: must not be "
                                    "below t3_tai_ns = 1772337637000000001")));
}

TEST(Mission, HasTheLaunchersChainWholeOrIsRefused) {
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

TEST(Mission, WithUnknownNamesIsRefused) {
  EXPECT_THAT(problems_of(std::string{kElements} + "[spni.noise]\nsun_pulse_s = 1\n"),
              ElementsAre("mission.toml:12: spni: unknown; did you mean spin?"));
  EXPECT_THAT(problems_of("colour = \"red\"\n" + std::string{kElements}),
              ElementsAre("mission.toml:1: colour: unknown; allowed here: alerts, contact, "
                          "ground_model, orbit, reconstruction, spacecraft, spin, three_axis"));
  EXPECT_THAT(problems_of(replaced(contract(), "\\[spin.noise\\]", "[spin.nose]")),
              ElementsAre(HasSubstr("spin.nose: unknown; did you mean noise?")));
}

TEST(Mission, WithAValueInPlaceOfATableIsRefused) {
  EXPECT_THAT(problems_of("spin = 3\n" + std::string{kElements}),
              ElementsAre("mission.toml:1: spin = 3: must be a table"));
  EXPECT_THAT(problems_of(std::string{kElements} + "[[spin.prior]]\nra_deg = 1\n"),
              ElementsAre(HasSubstr("mission.toml:12: spin.prior = ")));
  EXPECT_THAT(problems_of(std::string{kElements} + "[spacecraft.name]\n"),
              ElementsAre(HasSubstr("mission.toml:12: spacecraft.name: unknown")));
}

TEST(Mission, WithATableInPlaceOfAValueIsRefused) {
  EXPECT_THAT(
      problems_of(replaced(contract(), "slit_cant_deg = 45.0", "slit_cant_deg.value = 45.0")),
      ElementsAre(HasSubstr("spin.sun_sensor.slit_cant_deg = a table: must be a number in")));
}

TEST(Mission, ThatIsNoTomlIsRefusedWithLineAndColumn) {
  EXPECT_THAT(problems_of("[spacecraft]\nid = \"A\nkind"),
              ElementsAre(::testing::StartsWith("mission.toml:2:8: ")));
  EXPECT_THAT(problems_of("[spacecraft]\nid = \"A\"\nid = \"B\"\n"),
              ElementsAre(::testing::StartsWith("mission.toml:3:")));
  EXPECT_THAT(problems_of("\xff\xfe[spacecraft]"),
              ElementsAre(::testing::StartsWith("mission.toml:1:")));
}

TEST(Mission, ThatIsNotThereIsRefusedWithItsPath) {
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

TEST(Mission, WithABrokenOrbitFileIsRefusedNamingIt) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", "CCSDS_OEM_VERS = 2.0\nMETA_START\nrubbish\n");
  const auto mission = load_mission(folder.write("mission.toml", contract()));
  ASSERT_FALSE(mission);
  EXPECT_THAT(mission.error().message,
              AllOf(HasSubstr("mission.toml:5: orbit.oem = \"orbit.oem\": "),
                    ::testing::Not(HasSubstr("\n"))));
}

const std::string kEndless(100'000, 'x');

TEST(Mission, IsRefusedWithItsTextEscapedAndCut) {
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

TEST(Mission, ThatNestsTooDeepIsRefusedBeforeItIsParsed) {
  std::string deep = "[spacecraft]\n";
  for (int i = 0; i < 100'000; ++i) {
    deep += "a.";
  }
  EXPECT_THAT(problems_of(deep + "a = 1\n"),
              ElementsAre("mission.toml:2: tables and arrays must not stand deeper than 16 in each "
                          "other"));
}

TEST(Mission, WithAnOrbitFileOfOneEndlessLineIsRefusedByLine) {
  const TemporaryFolder folder;
  folder.write("orbit.oem", "CCSDS_OEM_VERS = 2.0\nCOMMENT " + kEndless);
  const auto mission =
      load_mission(folder.write("mission.toml", text_of(kData / "mission" / "contract.toml")));
  ASSERT_FALSE(mission);
  EXPECT_THAT(mission.error().message, HasSubstr("line 2: must be 1024 bytes long at most"));
  EXPECT_LT(mission.error().message.size(), 1000U);
}

TEST(Mission, HasTheLimitsOfAlertsThatThePipelinesHaveByThemselves) {
  const auto mission = load(kElements);
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->alerts, AlertLimits{});
}

TEST(Mission, KnowsThePlannedContact) {
  EXPECT_FALSE(load(kElements)->contact);
  const auto mission = load(contract());
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->contact->to - mission->contact->from, std::chrono::minutes{10});
  EXPECT_THAT(problems_of(replaced(contract(), "T03:10:00Z", "T03:00:00Z")),
              ElementsAre(HasSubstr("must be later than aos_utc")));
}

}  // namespace spindrift::mission_test
