#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/program.h"
#include "tests/support/recorded_files.h"
#include "tests/support/test_paths.h"

namespace spindrift::process_test {

using ::testing::HasSubstr;
using ::testing::Not;

/// Returns the end of a SELECT for the last row of an estimator.
std::string last(const std::string& estimator) {
  return " FROM spin_estimate WHERE estimator = '" + estimator + "' ORDER BY t_tai_ns DESC LIMIT 1";
}

nlohmann::json truth_of(const std::string& pass) {
  return nlohmann::json::parse(text_of(kPasses / pass / "truth.json"));
}

/// Returns the error of the estimate in the archive, deg.
double error_deg(const std::filesystem::path& db, const nlohmann::json& truth,
                 const std::string& estimator) {
  const auto place = [](double ra_deg, double dec_deg) {
    return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
  };
  return angle_between_rad(place(real_of(db, "SELECT ra_deg" + last(estimator)),
                                 real_of(db, "SELECT dec_deg" + last(estimator))),
                           place(truth["ra_deg"], truth["dec_deg"])) /
         kRadPerDeg;
}

struct Figure {
  const char* pass;
  double within_deg;
};

TEST(Process, FindsTheAxisOfEveryRecordedPassWithinItsFigureAndThreeOfItsSigma) {
  for (const auto& [pass, within_deg] : std::array<Figure, 4>{
           {{"nominal", 0.05}, {"dirty", 0.06}, {"north-only", 0.1}, {"gms5", 0.05}}}) {
    const TemporaryFolder folder;
    const auto db = folder.path() / "out.db";
    Program program{arguments(pass, db)};
    ASSERT_EQ(program.exit_status(), 0) << program.log();
    EXPECT_TRUE(nlohmann::json::parse(program.out())["runs"][0]["disagreements"].empty()) << pass;
    EXPECT_THAT(program.log(), Not(HasSubstr("disagree"))) << pass;
    for (const std::string estimator : {"mean", "sequential"}) {
      SCOPED_TRACE(std::string{pass} + " " + estimator);
      const double error = error_deg(db, truth_of(pass), estimator);
      EXPECT_LT(error, within_deg);
      EXPECT_LT(error, 3.0 * real_of(db, "SELECT sigma_deg" + last(estimator)));
      EXPECT_NEAR(real_of(db, "SELECT spin_rate_rpm" + last(estimator)), truth_of(pass)["rpm"],
                  4.0 * real_of(db, "SELECT sigma_rpm" + last(estimator)));
    }
  }
}

TEST(Process, PrintsWhatItStored) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  Program program{arguments("north-only", db)};
  ASSERT_EQ(program.exit_status(), 0) << program.log();

  const auto run = nlohmann::json::parse(program.out())["runs"][0];
  EXPECT_EQ(run["edges_received"], number_of(db, "SELECT count(*) FROM pulse"));
  EXPECT_EQ(run["edges_accepted"], number_of(db, "SELECT sum(accepted) FROM pulse_use"));
  EXPECT_EQ(run["residuals"].size(), 4U) << run["residuals"];
  for (const auto& [channel, residual] : run["residuals"].items()) {
    EXPECT_GT(residual["used"], 0.95) << channel;
    EXPECT_NEAR(residual["noise"], 1.0, 0.15) << channel;
  }
  EXPECT_EQ(run["revolutions"], number_of(db, "SELECT count(*) FROM revolution"));
  EXPECT_EQ(run["fixes_accepted"], number_of(db, "SELECT sum(accepted) FROM spin_fix"));
  EXPECT_EQ(run["fixes"], number_of(db, "SELECT count(*) FROM spin_fix"));
  for (const char* const group : {"geometry_case", "resolution"}) {
    const char* const key =
        group == std::string{"resolution"} ? "fixes_by_resolution" : "fixes_by_case";
    std::vector<std::string> counts;
    for (const auto& [name, count] : run[key].items()) {
      counts.push_back(name + "|" + count.dump() + "|");
    }
    EXPECT_THAT(rows_of(db, std::string{"SELECT "} + group + ", count(*) FROM spin_fix GROUP BY 1"),
                ::testing::UnorderedElementsAreArray(counts));
  }
  for (const std::string estimator : {"mean", "sequential"}) {
    EXPECT_EQ(run[estimator]["ra_deg"], real_of(db, "SELECT ra_deg" + last(estimator)));
    EXPECT_EQ(run[estimator]["t_tai_ns"], number_of(db, "SELECT t_tai_ns" + last(estimator)));
  }
  EXPECT_EQ(run["verdict"]["quality"].get<std::string>() + "|" +
                run["verdict"]["why"].get<std::string>() + "|",
            rows_of(db, "SELECT quality, why FROM pass_verdict").at(0));
  EXPECT_EQ(run["run_id"], rows_of(db, "SELECT run_id FROM run")
                               .at(0)
                               .substr(0, run["run_id"].get<std::string>().size()));
}

TEST(Process, SaysWhatBecameOfEveryEdge) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  Program program{arguments("nominal", db)};
  ASSERT_EQ(program.exit_status(), 0) << program.log();

  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(db,
                      "SELECT count(*) FROM pulse JOIN pulse_use USING"
                      " (spacecraft_id, t_tai_ns, channel)"),
            3600);
}

TEST(Process, KeepsTheProvenanceOfTheRun) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  Program program{arguments("nominal", db)};
  ASSERT_EQ(program.exit_status(), 0) << program.log();

  EXPECT_EQ(number_of(db,
                      "SELECT count(*) FROM run WHERE mode = 'process' AND spacecraft_id ="
                      " 'SPINNER' AND length(config_sha256) = 64 AND software_version != '' AND"
                      " started_utc LIKE '____-__-__T%Z' AND finished_utc >= started_utc"),
            1);
  EXPECT_EQ(rows_of(db, "SELECT config_toml FROM run").at(0),
            text_of(kPasses / "nominal" / "mission.toml") + "|");
}

TEST(Process, SaysWhenTheDiskIsFullAndEndsWithOne) {
  const TemporaryFolder folder;
  Program program{arguments("gms5", folder.path() / "out.db"), 600};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("rows that were accepted are not in archive"));
}

TEST(Process, KeepsWhereTheTelemetryCameFrom) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  Program program{arguments("nominal", db)};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(rows_of(db, "SELECT telemetry FROM run_telemetry").at(0),
            (kPasses / "nominal").string() + "|");
  EXPECT_EQ(number_of(db, "SELECT length(orbit_sha256) FROM run"), 64);
}

TEST(Process, KeepsTheNameThatTheRunIsGivenAndWhatItsTelemetryWas) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  auto labelled = arguments("nominal", db);
  labelled.insert(labelled.end(), {"--label", "second try"});
  Program program{labelled};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(rows_of(db,
                    "SELECT label, length(telemetry_sha256), last_tai_ns ="
                    " (SELECT max(t_tai_ns) FROM pulse), contact_share IS NULL FROM run"),
            std::vector<std::string>{"second try|64|1|1|"});
}

/// The warnings printed for a run are also stored in the archive.
TEST(Process, KeepsItsWarnings) {
  const PassCopy pass{"nominal"};
  pass.folder.write("more.csv",
                    "t_tai_ns,channel,spacecraft\nsoon,sun1,SPINNER\n"
                    "1795143637568806257,sun1,OTHER\n");
  // The pulses have a gap of seven minutes.
  std::istringstream rows{text_of(pass.folder.path() / "pulses.csv")};
  std::string header;
  std::getline(rows, header);
  std::string apart = header + "\n";
  int count = 0;
  for (std::string row; std::getline(rows, row); ++count) {
    const auto comma = row.find(',');
    const std::int64_t later_ns = count < 1800 ? 0 : 420'000'000'000;
    apart += std::to_string(std::stoll(row.substr(0, comma)) + later_ns) + row.substr(comma) + "\n";
  }
  pass.folder.write("pulses.csv", apart);
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();

  const auto answer = nlohmann::json::parse(program.out());
  std::vector<std::string> told;
  for (const auto& warning : answer["warnings"]) {
    told.push_back(warning["code"].get<std::string>() + "|" + warning["values"].dump() + "|");
  }
  EXPECT_THAT(rows_of(pass.db, "SELECT code, arguments FROM notice"),
              ::testing::UnorderedElementsAreArray(told));
  EXPECT_THAT(rows_of(pass.db, "SELECT code FROM notice"),
              ::testing::IsSupersetOf({"bad_rows|", "other_spacecraft|", "silences|"}));
}

TEST(Process, AddsARunWithoutStoringAnEdgeTwice) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  for (int i = 0; i < 2; ++i) {
    Program program{arguments("nominal", db)};
    ASSERT_EQ(program.exit_status(), 0) << program.log();
  }

  EXPECT_EQ(number_of(db, "SELECT count(*) FROM run"), 2);
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse_use"), 7200);
}

TEST(Process, GivesTheSameRowsWhateverTheOrderOfTheFile) {
  const PassCopy pass{"north-only"};
  std::istringstream csv{text_of(pass.folder.path() / "pulses.csv")};
  std::string header;
  std::getline(csv, header);
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) {
    lines.push_back(line);
  }
  std::shuffle(lines.begin(), lines.end(), std::mt19937{20261120});
  std::string shuffled = header + "\n";
  for (const std::string& line : lines) {
    shuffled += line + "\n";
  }
  pass.folder.write("pulses.csv", shuffled);

  const auto in_order = pass.folder.path() / "in_order.db";
  Program first{arguments("north-only", in_order)};
  Program second{pass.arguments_here()};
  ASSERT_EQ(first.exit_status(), 0) << first.log();
  ASSERT_EQ(second.exit_status(), 0) << second.log();
  EXPECT_EQ(product_rows(in_order), product_rows(pass.db));
}

/// Appends the edges of the recorded pass again, `later_s` later.
void append_a_second_pass(const PassCopy& pass, std::int64_t later_s) {
  std::istringstream csv{text_of(pass.folder.path() / "pulses.csv")};
  std::string line;
  std::getline(csv, line);
  std::string second = line + "\n";
  while (std::getline(csv, line)) {
    const std::size_t comma = line.find(',');
    second +=
        std::to_string(std::stoll(line) + later_s * 1'000'000'000) + line.substr(comma) + "\n";
  }
  pass.folder.write("second.csv", second);
}

TEST(Process, MakesARunOfEachPass) {
  const PassCopy pass{"north-only"};
  append_a_second_pass(pass, 7200);
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();

  const auto runs = rows_of(pass.db,
                            "SELECT run_id, min(revolution), count(*) FROM revolution JOIN run"
                            " USING (run_id) GROUP BY run_id ORDER BY first_arrival");
  ASSERT_EQ(runs.size(), 2U);
  const auto report = nlohmann::json::parse(program.out())["runs"];
  ASSERT_EQ(report.size(), 2U);
  std::int64_t edges = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(runs[i], report[i]["run_id"].get<std::string>() + "|0|" +
                           report[i]["revolutions"].dump() + "|");
    edges += report[i]["edges_received"].get<std::int64_t>();
  }
  EXPECT_EQ(report[0]["edges_received"], report[1]["edges_received"]);
  EXPECT_EQ(edges, number_of(pass.db, "SELECT count(*) FROM pulse_use"));

  const TemporaryFolder alone;
  Program one{arguments("north-only", alone.path() / "out.db")};
  ASSERT_EQ(one.exit_status(), 0) << one.log();
  const auto rows_of_run = [&](const std::filesystem::path& db, const std::string& run) {
    return rows_of(db,
                   "SELECT revolution, quantity, value, sigma FROM spin_measurement WHERE"
                   " run_id = '" +
                       run + "' ORDER BY 1, 2");
  };
  const std::string run = nlohmann::json::parse(one.out())["runs"][0]["run_id"];
  EXPECT_EQ(rows_of_run(pass.db, report[0]["run_id"]), rows_of_run(alone.path() / "out.db", run));
}

TEST(Process, StoresThePassAndSaysWhereTheOrbitDoesNotReach) {
  const PassCopy pass{"nominal"};
  std::filesystem::copy_file(kPasses / "gms5" / "orbit.oem", pass.folder.path() / "orbit.oem",
                             std::filesystem::copy_options::overwrite_existing);
  Program program{pass.arguments_here()};
  EXPECT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_THAT(program.log(), HasSubstr("orbit: "));
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM spin_fix"), 0);
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM revolution"),
            599);  // One sun1 edge is a 3-sigma outlier.
}

TEST(Process, CountsAnEdgeThatIsSentTwiceOnceAmongTheStored) {
  const PassCopy pass{"nominal"};
  pass.folder.write("again.csv", text_of(pass.folder.path() / "pulses.csv"));
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  const auto run = nlohmann::json::parse(program.out())["runs"][0];
  EXPECT_EQ(run["edges_received"], 7200);
  EXPECT_EQ(run["edges_stored"], 3600);
}

TEST(Process, SaysOnceThatPulsesAndCodedFramesOfASpacecraftCame) {
  const PassCopy pass{"nominal"};
  pass.folder.write("coded.csv",
                    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n"
                    "1795143637568806257,0.6,,,,,\n1795143638168806257,0.6,,,,,\n");
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  const std::string words = "both pulses and coded frames";
  const std::string log = program.log();
  EXPECT_THAT(log, HasSubstr(words));
  EXPECT_EQ(log.find(words), log.rfind(words));
}

TEST(Process, GivesTheSameRowsWhateverFilesThePulsesStandIn) {
  const PassCopy pass{"north-only"};
  std::istringstream csv{text_of(pass.folder.path() / "pulses.csv")};
  std::string header;
  std::getline(csv, header);
  std::vector<std::string> files(3, header + "\n");
  std::mt19937 random{20261121};
  for (std::string line; std::getline(csv, line);) {
    files.at(random() % 3) += line + "\n";
  }
  std::filesystem::remove(pass.folder.path() / "pulses.csv");
  std::vector<std::string> command =
      arguments(pass.mission(), pass.folder.write("c.csv", files[0]), pass.db);
  const auto telemetry = std::find(command.begin(), command.end(), "--telemetry") + 1;
  command.insert(telemetry, {pass.folder.write("a.csv", files[1]).string(),
                             pass.folder.write("b.csv", files[2]).string()});
  const auto in_order = pass.folder.path() / "in_order.db";
  Program first{arguments("north-only", in_order)};
  Program second{command};
  ASSERT_EQ(first.exit_status(), 0) << first.log();
  ASSERT_EQ(second.exit_status(), 0) << second.log();
  EXPECT_EQ(product_rows(in_order), product_rows(pass.db));
}

TEST(Process, ReadsALargeFileInBoundedMemory) {
  if (is_sanitized()) {
    GTEST_SKIP() << "sanitizers need memory of their own";
  }
  // The file has 60 MB: pulses of another spacecraft, which are only counted, around the pass.
  const PassCopy pass{"nominal"};
  constexpr std::int64_t kOthers = 1'800'000;
  std::string text = "t_tai_ns,channel,spacecraft\n";
  for (std::int64_t i = 0; i < kOthers; ++i) {
    text += std::to_string(1795143637000000000 + i * 300'000) + ",north_out,OTHER\n";
  }
  ASSERT_GT(text.size(), 60'000'000U);
  pass.folder.write("other.csv", text);
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_LT(program.peak_kib(), 256 * 1024);
  EXPECT_EQ(nlohmann::json::parse(program.out())["other_spacecraft"]["OTHER"], kOthers);
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pulse_use WHERE rejected_by = 'late'"), 0);
}

TEST(Process, CountsAndLeavesTheEdgesOfAnotherSpacecraft) {
  const PassCopy pass{"nominal"};
  pass.folder.write("other.csv", "t_tai_ns,channel,spacecraft\n1795143637568806257,sun1,OTHER\n");
  Program program{pass.arguments_here()};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(nlohmann::json::parse(program.out())["other_spacecraft"],
            (nlohmann::json{{"OTHER", 1}}));
  EXPECT_THAT(program.log(), HasSubstr("'OTHER'"));
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM rejected_input"), 0);
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pulse"), 3600);
}

/// Repeats the pass so often that the program cannot finish before the signal.
void repeat_pulses(const std::filesystem::path& file) {
  std::ifstream in{file};
  std::string header;
  std::getline(in, header);
  std::vector<std::pair<std::int64_t, std::string>> rows;
  for (std::string row; std::getline(in, row);) {
    rows.emplace_back(std::stoll(row), row.substr(row.find(',')));
  }
  in.close();
  constexpr std::int64_t kPass_ns = 600'000'000'000;
  std::ofstream out{file};
  out << header << '\n';
  for (std::int64_t pass = 0; pass < 500; ++pass) {
    for (const auto& [t_tai_ns, rest] : rows) {
      out << t_tai_ns + pass * kPass_ns << rest << '\n';
    }
  }
}

TEST(Process, ThatIsInterruptedSaysSoAndLeavesARunThatIsNotFinished) {
  const PassCopy pass{"nominal"};
  repeat_pulses(pass.folder.path() / "pulses.csv");
  Program program{pass.arguments_here()};
  ASSERT_TRUE(eventually([&] {
    return std::filesystem::exists(pass.db) &&
           number_of(pass.db, "SELECT count(*) FROM sqlite_schema WHERE name = 'pulse_use'") == 1 &&
           number_of(pass.db, "SELECT count(*) FROM spin_estimate") > 0;
  }));
  program.signal(SIGINT);
  EXPECT_EQ(program.exit_status(), 1) << program.log();
  const auto run = nlohmann::json::parse(program.out())["runs"][0];
  EXPECT_EQ(run["finished"], false);
  EXPECT_EQ(run["edges_received"], number_of(pass.db, "SELECT count(*) FROM pulse"));
  EXPECT_EQ(number_of(pass.db, "SELECT count(*) FROM pass_verdict WHERE finished = 0"), 1);
  EXPECT_GT(number_of(pass.db, "SELECT count(*) FROM pass_answer WHERE finished = 0"), 0);
}

TEST(Process, RefusesAnArchiveThatSqliteWouldNotTakeForAFile) {
  for (const std::string name : {":memory:", "file:pass.db"}) {
    Program program{arguments("nominal", name)};
    EXPECT_EQ(program.exit_status(), 2) << program.log();
    EXPECT_THAT(program.log(), HasSubstr("takes this name for something else than a file"));
  }
}

}  // namespace spindrift::process_test
