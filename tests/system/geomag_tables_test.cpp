/// Tables of the field made, read and compiled as their users do.

#include <sys/stat.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"
#include "tests/support/test_paths.h"

namespace spindrift::geomag_tables_test {

constexpr double kEccentricity = 0.1;
const std::string kMission = R"([spacecraft]
id = "FEMTOSAT"
kind = "three_axis"
[orbit.elements]
epoch_tai_ns = 1772337637000000000
a_km = 8000.0
e = 0.1
i_deg = 97.0
raan_deg = 10.0
argp_deg = 10.0
mean_anomaly_deg = 30.0
[three_axis.sun_sensor]
noise_deg = 0.6
[three_axis.magnetometer]
noise_nt = 100.0
)";

KeplerOrbit orbit_of_mission() {
  return KeplerOrbit::make({.epoch = tai_from_ns(1772337637000000000),
                            .semi_major_axis_km = 8000.0,
                            .eccentricity = kEccentricity,
                            .inclination_rad = 97.0 * kRadPerDeg,
                            .raan_rad = 10.0 * kRadPerDeg,
                            .argument_of_perigee_rad = 10.0 * kRadPerDeg,
                            .mean_anomaly_rad = 30.0 * kRadPerDeg})
      .value();
}

class GeomagTables : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Words table(const std::string& kind, const std::string& points) const {
    return {"geomag",
            "table",
            "--mission",
            mission_,
            "--date=2026.2",
            "--kind=" + kind,
            "--points=" + points,
            "--out",
            path(kind + ".bin"),
            "--header",
            path(kind + ".h")};
  }
  Words lookup(const std::string& table, const std::string& kind, const std::string& text) const {
    return {"geomag",
            "lookup",
            "--table",
            path(table),
            "--kind=" + kind,
            "--points",
            folder_.write("anomalies.csv", text)};
  }

  TemporaryFolder folder_;
  std::string mission_ = folder_.write("mission.toml", kMission);
};

struct Row {
  double deg;
  std::array<double, 3> field_nt;
};

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "anomaly_deg,x_nt,y_nt,z_nt");
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    Row& row = rows.emplace_back();
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &row.deg, row.field_nt.data(),
                          &row.field_nt[1], &row.field_nt[2]),
              4);
  }
  return rows;
}

const std::string kAnomalies = "anomaly_deg\n0\n0.5\n17.25\n90\n179.999\n251.3\n359.9\n360\n";

class OfEachKind : public GeomagTables, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, OfEachKind, ::testing::Values("uniform", "curvature", "chebyshev"));

TEST_P(OfEachKind, FileHasTheBytesOfTheContract) {
  const std::string kind = GetParam();
  EXPECT_THAT(succeeded(table(kind, "80")).out, HasSubstr(kind + " of 80 points"));
  const std::string bytes = text_of(path(kind + ".bin"));
  ASSERT_EQ(bytes.size(), kind == "curvature" ? 8U + 80U * 16U : 968U);
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 4, sizeof count);
  EXPECT_EQ(count, 80U);
}

/// Compiles the header as a user's C99 and returns what its program prints.
std::string compiled(const std::string& compiler, const std::string& folder,
                     const std::string& source) {
  const std::string command = compiler + " -std=c99 -pedantic -Wall -Wextra -Werror -o " + folder +
                              "/" + compiler + ".out " + source + " -lm && " + folder + "/" +
                              compiler + ".out > " + folder + "/printed";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return text_of(folder + "/printed");
}

TEST_P(OfEachKind, HeaderGivesWhatTheProgramGives) {
  const std::string kind = GetParam();
  succeeded(table(kind, "80"));
  const auto expected = rows_of(succeeded(lookup(kind + ".bin", kind, kAnomalies)).out);
  std::string program = "#include <stdio.h>\n#include \"" + kind + ".h\"\nint main(void) {\n" +
                        "double b[3];\nputs(\"anomaly_deg,x_nt,y_nt,z_nt\");\n";
  for (const Row& row : expected) {
    program += kind + "_lookup(" + std::to_string(row.deg) +
               " / 57.29577951308232, b);\nprintf(\"%f,%.4f,%.4f,%.4f\\n\", " +
               std::to_string(row.deg) + ", b[0], b[1], b[2]);\n";
  }
  const std::string source = folder_.write("main.c", program + "return 0;\n}\n");
  for (const std::string compiler : {"gcc", "clang"}) {
    const auto given = rows_of(compiled(compiler, folder_.path().string(), source));
    ASSERT_EQ(given.size(), expected.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(given[i].field_nt.at(axis), expected[i].field_nt.at(axis), 0.01)
            << compiler << " at " << expected[i].deg;
      }
    }
  }
}

TEST_F(GeomagTables, HeaderHasTheAnomalyOfAFixAndOfATime) {
  succeeded(table("uniform", "80"));
  const KeplerOrbit orbit = orbit_of_mission();
  std::string program =
      "#include <stdio.h>\n#include \"uniform.h\"\nint main(void) {\ndouble p[3];\n";
  // The second is a metre before the epoch, the last two are a revolution later.
  const std::vector<double> anomalies_rad{0.0, -1.3e-7, 0.01, 1.0, 3.0, 4.5, 6.2, 6.3, 9.0};
  for (const double anomaly_rad : anomalies_rad) {
    const TaiTime t = orbit.when_behind_epoch(anomaly_rad);
    const Eigen::Vector3d p_km =
        earth_orientation(t).conjugate() * orbit.at(t).value().position_icrf_km;
    const std::string since_s = std::to_string(seconds_between(orbit.epoch(), t));
    program += "p[0] = " + std::to_string(p_km.x()) + "; p[1] = " + std::to_string(p_km.y()) +
               "; p[2] = " + std::to_string(p_km.z()) +
               ";\nprintf(\"%.9f %.9f\\n\", uniform_anomaly_of_fix(p, " + since_s +
               "), uniform_anomaly_of_time(" + since_s + "));\n";
  }
  std::istringstream printed{compiled("gcc", folder_.path().string(),
                                      folder_.write("main.c", program + "return 0;\n}\n"))};
  for (const double anomaly_rad : anomalies_rad) {
    double of_fix_rad = 0.0;
    double of_time_rad = 0.0;
    ASSERT_TRUE(printed >> of_fix_rad >> of_time_rad);
    EXPECT_NEAR(of_fix_rad, anomaly_rad, 1e-5);
    EXPECT_NEAR(of_time_rad, anomaly_rad, 1e-7);
  }
}

TEST_F(GeomagTables, HeaderCompilesWhateverTheNameAndReadsNothingOutside) {
  std::string named = kMission;
  folder_.write("mission.toml", named.replace(named.find("FEMTOSAT"), 8, "A*/B /* C"));
  for (const std::string kind : {"uniform", "curvature", "chebyshev"}) {
    succeeded(table(kind, "80"));
    const std::string source =
        folder_.write("main.c", "#include <stdio.h>\n#include \"" + kind +
                                    ".h\"\nint main(void) {\ndouble b[3];\n" + kind +
                                    "_lookup(NAN, b);\n"
                                    "printf(\"%d\", b[0] != b[0]);\n" +
                                    kind +
                                    "_lookup(INFINITY, b);\n"
                                    "printf(\"%d\", b[0] != b[0]);\nreturn 0;\n}\n");
    EXPECT_EQ(compiled("gcc", folder_.path().string(), source), "11") << kind;
    for (const std::string compiler : {"gcc", "clang"}) {
      const std::string alone =
          compiler + " -std=c99 -pedantic -Wall -Wextra -Werror -fsyntax-only " + path(kind + ".h");
      EXPECT_EQ(std::system(alone.c_str()), 0) << alone;
    }
  }
}

TEST_F(GeomagTables, HeadersOfSeveralTablesFitInOneProgram) {
  std::string program = "#include <stdio.h>\n";
  for (const std::string kind : {"uniform", "curvature", "chebyshev"}) {
    Words command = table(kind, "80");
    command.back() = path("2 " + kind + ".h");
    succeeded(command);
    program += "#include \"2 " + kind + ".h\"\n";
  }
  program += "int main(void) {\ndouble b[3];\n";
  for (const std::string kind : {"uniform", "curvature", "chebyshev"}) {
    program += "field_2_" + kind + "_lookup(0.0, b);\nprintf(\"%.1f \", b[0]);\n";
  }
  std::istringstream printed{compiled("gcc", folder_.path().string(),
                                      folder_.write("main.c", program + "return 0;\n}\n"))};
  std::array<double, 3> ahead_nt{};
  ASSERT_TRUE(printed >> ahead_nt[0] >> ahead_nt[1] >> ahead_nt[2]);
  EXPECT_EQ(ahead_nt[0], ahead_nt[1]);
  EXPECT_NEAR(ahead_nt[0], ahead_nt[2], 0.2);
}

TEST_F(GeomagTables, StudyShowsThatTheTableIsALittleOfTheError) {
  const auto study =
      nlohmann::json::parse(succeeded({"geomag", "study", "--mission", mission_, "--date=2026.2",
                                       "--out", folder_.path().string(), "--json"})
                                .out);
  for (const char* const angle : {"phi", "theta", "psi"}) {
    const auto& errors = study["largest_attitude_error_deg"];
    EXPECT_LT(errors["with_table"][angle].get<double>(), 7.0);
    EXPECT_LT(errors["by_table"][angle].get<double>(),
              0.2 * errors["with_field"][angle].get<double>());
  }
  for (const char* const plot : {"length", "knots", "weight", "armse", "attitude"}) {
    EXPECT_THAT(text_of(path(plot + std::string{".svg"})), HasSubstr("</svg>"));
  }
}

TEST_F(GeomagTables, RefuseWhatCannotBe) {
  refused(table("uniform", "3"), {"must be 4 to 100000"});
  refused(table("uniform", "100001"), {"must be 4 to 100000"});
  refused(table("chebyshev", "100001"), {"must be 4 to 100000"});
  refused(table("cubic", "80"), {"--kind cubic: must be uniform, curvature or chebyshev"});
  Words over = table("uniform", "80");
  over.back() = path("uniform.bin");
  refused(over, {"must be different files"});
  Words late = table("uniform", "80");
  late[4] = "--date=2031";
  refused(late, {"known from 1900 to 2030"});
  const std::size_t orbit = kMission.find("[orbit");
  const std::string bare = kMission.substr(0, orbit) + kMission.substr(kMission.find("[three"));
  folder_.write("mission.toml", bare);
  refused(table("uniform", "80"), {"[orbit.elements]"});
  folder_.write("mission.toml", kMission);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  Words into_pipe = table("uniform", "80");
  into_pipe.back() = path("pipe");
  refused(into_pipe, {"pipe: is there and is no file"});
}

TEST_F(GeomagTables, LookupRefusesOtherFilesAndAnomalies) {
  for (const char* const kind : {"uniform", "curvature", "chebyshev"}) {
    succeeded(table(kind, "80"));
  }
  refused(lookup("uniform.bin", "curvature", kAnomalies), {"of another kind or length"});
  refused(lookup("curvature.bin", "uniform", kAnomalies), {"of another kind or length"});
  refused(lookup("chebyshev.bin", "uniform", kAnomalies), {"these look like coefficients"});
  refused(lookup("uniform.bin", "chebyshev", kAnomalies), {"these look like fields"});
  std::ofstream{path("uniform.bin"), std::ios::app} << "x";
  refused(lookup("uniform.bin", "uniform", kAnomalies), {"of another kind or length"});
  refused(lookup("chebyshev.bin", "chebyshev", "anomaly_deg\nnorth\n"), {"anomalies.csv:2"});
  refused(lookup("chebyshev.bin", "chebyshev", "anomaly_deg\nnan\n"), {"anomalies.csv:2"});
  refused(lookup("chebyshev.bin", "chebyshev", "anomaly_deg\n361\n"), {"[0, 360]"});
  refused(lookup("chebyshev.bin", "chebyshev", "deg\n1\n"), {"must begin with the header"});
  // Near the apogee of such an orbit the field fades as coefficients do.
  std::string far = kMission;
  far.replace(far.find("8000.0\ne = 0.1"), 14, "24400.0\ne = 0.73");
  far.replace(far.find("anomaly_deg = 30.0"), 18, "anomaly_deg = 180.0");
  folder_.write("mission.toml", far);
  succeeded(table("uniform", "80"));
  refused(lookup("uniform.bin", "chebyshev", kAnomalies), {"more than the Earth's field has"});
}

TEST(Femtosatellite, ComputesItsAttitudeItselfByItsTable) {
  const Simulated simulated{"femto.toml"};
  const auto on_board = nlohmann::json::parse(text_of(simulated.pass / "truth.json"))["on_board"];
  EXPECT_EQ(on_board["table_bytes"], 8 + 80 * 16);
  EXPECT_GT(on_board["attitudes"], 3500);
  EXPECT_LT(on_board["error_with_table"]["largest_deg"], 7.0);
  EXPECT_LT(on_board["moved_by_table"]["largest_deg"], 0.2);
  EXPECT_LT(on_board["moved_by_table"]["rms_deg"].get<double>(),
            0.05 * on_board["error_with_field"]["rms_deg"].get<double>());

  const Ran said = succeeded({"simulate", simulated.scenario, "--out", simulated.pass, "--plots"});
  EXPECT_THAT(said.out, HasSubstr("the table moves the attitude by at most 0.1"));
  EXPECT_THAT(text_of(simulated.pass / "flight.svg"), HasSubstr("computed on board, deg"));
}

TEST(Femtosatellite, IsOffByMoreWhenItReadsItsTableAgain) {
  const Simulated simulated{"femto.toml", {{"5860.0", "6500.0"}}};
  const auto on_board = nlohmann::json::parse(text_of(simulated.pass / "truth.json"))["on_board"];
  EXPECT_GT(on_board["moved_by_table"]["largest_deg"], 3.0);
}

}  // namespace spindrift::geomag_tables_test
