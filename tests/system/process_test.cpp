#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/eventually.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/test_paths.h"

namespace spindrift::process_test {

/// Returns the end of a SELECT for the last row of an estimator.
std::string last(const std::string& estimator) {
  return " FROM spin_estimate WHERE estimator = '" + estimator + "' ORDER BY t_tai_ns DESC LIMIT 1";
}

struct Figure {
  const char* pass;
  double within_deg;
};

TEST(Process, FindsTheAxisOfEveryRecordedPassWithinItsFigureAndThreeOfItsSigma) {
  for (const auto& [pass, within_deg] : std::array<Figure, 4>{
           {{"nominal", 0.05}, {"dirty", 0.06}, {"north-only", 0.1}, {"gms5", 0.05}}}) {
    const Processed processed{pass};
    const auto truth = nlohmann::json::parse(text_of(kPasses / pass / "truth.json"));
    EXPECT_TRUE(processed.run["disagreements"].empty()) << pass;
    for (const char* const warning : {"disagree", "jumps", "no orbit"}) {
      EXPECT_THAT(processed.log, Not(HasSubstr(warning))) << pass;
    }
    for (const std::string estimator : {"mean", "sequential"}) {
      SCOPED_TRACE(std::string{pass} + " " + estimator);
      const auto real = [&](const std::string& column) {
        return real_of(processed.db, "SELECT " + column + last(estimator));
      };
      const double error = error_deg(axis_in(processed.db, last(estimator)), truth);
      EXPECT_LT(error, within_deg);
      EXPECT_LT(error, 3.0 * real("sigma_deg"));
      EXPECT_NEAR(real("spin_rate_rpm"), truth["rpm"], 4.0 * real("sigma_rpm"));
    }
  }
}

TEST(Process, PrintsWhatItStored) {
  const Processed processed{"north-only"};
  const auto& db = processed.db;
  const auto& run = processed.run;
  EXPECT_EQ(run["edges_received"], count_rows(db, "pulse"));
  EXPECT_EQ(run["edges_accepted"], number_of(db, "SELECT sum(accepted) FROM pulse_use"));
  // The ninth is a mixed azimuth of one revolution without sun1.
  EXPECT_EQ(run["residuals"].size(), 9U) << run["residuals"];
  for (const char* channel : {"sun1", "sun2", "north_in", "north_out"}) {
    EXPECT_GT(run["residuals"][channel]["used"], 0.95) << channel;
    EXPECT_NEAR(run["residuals"][channel]["noise"], 1.0, 0.15) << channel;
  }
  // The share of the ledger forgets slowly, that of the archive does not.
  for (const char* quantity : {"period", "sun_angle", "north_chord", "north_dihedral"}) {
    EXPECT_NEAR(run["residuals"][quantity]["used"],
                real_of(db, fmt::format("SELECT avg(accepted) FROM spin_measurement WHERE "
                                        "quantity = '{}' AND expected IS NOT NULL",
                                        quantity)),
                1e-3)
        << quantity;
  }
  EXPECT_EQ(run["revolutions"], count_rows(db, "revolution"));
  EXPECT_EQ(run["fixes_accepted"], number_of(db, "SELECT sum(accepted) FROM spin_fix"));
  EXPECT_EQ(run["fixes"], count_rows(db, "spin_fix"));
  for (const auto& [group, key] : {std::pair{"geometry_case", "fixes_by_case"},
                                   std::pair{"resolution", "fixes_by_resolution"}}) {
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
  EXPECT_THAT(rows_of(db, "SELECT run_id FROM run"),
              ElementsAre(run["run_id"].get<std::string>() + "|"));
}

TEST(Process, KeepsTheProvenanceOfEachRunAndStoresEveryEdgeOnce) {
  const Processed processed{"nominal", {"--label", "second try"}};
  const auto& db = processed.db;
  EXPECT_EQ(count_rows(db,
                       "run WHERE mode = 'process' AND spacecraft_id = 'SPINNER' AND "
                       "length(config_sha256) = 64 AND software_version != '' AND started_utc LIKE "
                       "'____-__-__T%Z' AND finished_utc >= started_utc"),
            1);
  EXPECT_EQ(rows_of(db, "SELECT config_toml FROM run").at(0),
            text_of(kPasses / "nominal" / "mission.toml") + "|");
  EXPECT_EQ(rows_of(db, "SELECT telemetry FROM run_telemetry").at(0),
            (kPasses / "nominal").string() + "|");
  EXPECT_THAT(rows_of(db,
                      "SELECT label, length(orbit_sha256), length(telemetry_sha256), last_tai_ns = "
                      "(SELECT max(t_tai_ns) FROM pulse), contact_share IS NULL FROM run"),
              ElementsAre("second try|64|64|1|1|"));
  EXPECT_EQ(count_rows(db, "pulse"), 3600);
  EXPECT_EQ(count_rows(db, "pulse JOIN pulse_use USING (spacecraft_id, t_tai_ns, channel)"), 3600);

  succeeded(arguments("nominal", db));
  EXPECT_EQ(count_rows(db, "run"), 2);
  EXPECT_EQ(count_rows(db, "pulse"), 3600);
  EXPECT_EQ(count_rows(db, "pulse_use"), 7200);
}

TEST(Process, SaysWhenTheDiskIsFullAndEndsWithOne) {
  const TemporaryFolder folder;
  Program program{arguments("gms5", folder.path() / "out.db"), 600};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("rows that were accepted are not in archive"));
}

/// The warnings printed for a run are also stored in the archive.
TEST(Process, KeepsItsWarningsAndLeavesTheEdgesOfAnotherSpacecraft) {
  const PassCopy pass{"nominal"};
  pass.folder.write("more.csv",
                    "t_tai_ns,channel,spacecraft\nsoon,sun1,SPINNER\n"
                    "1795143637568806257,sun1,OTHER\n");
  // The pulses have a gap of seven minutes.
  int count = 0;
  pass.folder.write("pulses.csv",
                    with_rows(text_of(kPasses / "nominal/pulses.csv"), [&](const std::string& row) {
                      return later_row(row, ++count <= 1800 ? 0 : 420'000'000'000);
                    }));
  const Ran program = succeeded(pass.arguments_here());
  const auto answer = program.json();
  std::vector<std::string> told;
  for (const auto& warning : answer["warnings"]) {
    told.push_back(warning["code"].get<std::string>() + "|" + warning["values"].dump() + "|");
  }
  EXPECT_THAT(rows_of(pass.db, "SELECT code, arguments FROM notice"),
              ::testing::UnorderedElementsAreArray(told));
  EXPECT_THAT(rows_of(pass.db, "SELECT code FROM notice"),
              ::testing::IsSupersetOf({"bad_rows|", "other_spacecraft|", "silences|"}));
  EXPECT_EQ(answer["other_spacecraft"], (nlohmann::json{{"OTHER", 1}}));
  EXPECT_THAT(program.log, HasSubstr("'OTHER'"));
  EXPECT_EQ(count_rows(pass.db, "rejected_input"), 1);
  EXPECT_EQ(count_rows(pass.db, "pulse"), 3600);
}

TEST(Process, GivesTheSameRowsInWhateverOrderAndFilesThePulsesStand) {
  const auto expected = product_rows(Processed{"north-only"}.db);
  const auto lines = lines_of(text_of(kPasses / "north-only" / "pulses.csv"));
  const PassCopy shuffled{"north-only"};
  auto other_lines = lines;
  std::shuffle(other_lines.begin() + 1, other_lines.end(), std::mt19937{20261120});
  shuffled.folder.write("pulses.csv", fmt::format("{}\n", fmt::join(other_lines, "\n")));
  succeeded(shuffled.arguments_here());
  EXPECT_EQ(product_rows(shuffled.db), expected);

  const PassCopy spread{"north-only"};
  std::vector<std::string> files(3, lines[0] + "\n");
  std::mt19937 random{20261121};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    files.at(random() % 3) += lines[i] + "\n";
  }
  succeeded({"process", "--mission", spread.mission(), "--db", spread.db, "--telemetry",
             spread.folder.write("a.csv", files[1]), spread.folder.write("b.csv", files[2]),
             spread.folder.write("c.csv", files[0])});
  EXPECT_EQ(product_rows(spread.db), expected);
}

TEST(Process, MakesARunOfEachPass) {
  const PassCopy pass{"north-only"};
  constexpr std::int64_t kLater_ns = 7'200'000'000'000;
  pass.folder.write("second.csv",
                    with_rows(text_of(kPasses / "north-only" / "pulses.csv"),
                              [](const auto& row) { return later_row(row, kLater_ns); }));
  const auto report = succeeded(pass.arguments_here()).json()["runs"];
  const auto runs = rows_of(pass.db,
                            "SELECT run_id, min(revolution), count(*) FROM revolution JOIN run "
                            "USING (run_id) GROUP BY run_id ORDER BY first_arrival");
  ASSERT_EQ(runs.size(), 2U);
  ASSERT_EQ(report.size(), 2U);
  std::int64_t edges = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(runs[i], report[i]["run_id"].get<std::string>() + "|0|" +
                           report[i]["revolutions"].dump() + "|");
    edges += report[i]["edges_received"].get<std::int64_t>();
  }
  EXPECT_EQ(report[0]["edges_received"], report[1]["edges_received"]);
  EXPECT_EQ(edges, count_rows(pass.db, "pulse_use"));

  const Processed alone{"north-only"};
  const auto rows_of_run = [&](const std::filesystem::path& db, const std::string& run) {
    return rows_of(
        db, "SELECT revolution, quantity, value, sigma FROM spin_measurement WHERE run_id = '" +
                run + "' ORDER BY 1, 2");
  };
  EXPECT_EQ(rows_of_run(pass.db, report[0]["run_id"]), rows_of_run(alone.db, alone.run["run_id"]));
}

TEST(Process, StoresThePassAndSaysWhereTheOrbitDoesNotReach) {
  const PassCopy pass{"nominal"};
  std::filesystem::copy_file(kPasses / "gms5" / "orbit.oem", pass.folder.path() / "orbit.oem",
                             std::filesystem::copy_options::overwrite_existing);
  refused(pass.arguments_here(),
          {"orbit: ", "SPINNER: the orbit covers ",
           ", and the telemetry 2026-11-20T03:00:00Z to 2026-11-20T03:10:00Z: without the orbit of "
           "these dates there is no answer\n"});
  EXPECT_EQ(count_rows(pass.db, "pulse"), 3600);
  EXPECT_EQ(count_rows(pass.db, "spin_fix"), 0);
  // One sun1 edge is a 3-sigma outlier.
  EXPECT_EQ(count_rows(pass.db, "revolution"), 599);
}

TEST(Process, CountsAnEdgeThatIsSentTwiceOnceAmongTheStored) {
  const PassCopy pass{"nominal"};
  pass.folder.write("again.csv", text_of(pass.folder.path() / "pulses.csv"));
  const auto run = succeeded(pass.arguments_here()).json()["runs"][0];
  EXPECT_EQ(run["edges_received"], 7200);
  EXPECT_EQ(run["edges_stored"], 3600);
}

TEST(Process, SaysOnceThatPulsesAndCodedFramesOfASpacecraftCame) {
  const PassCopy pass{"nominal"};
  pass.folder.write("coded.csv",
                    "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n"
                    "1795143637568806257,0.6,,,,,\n1795143638168806257,0.6,,,,,\n");
  expect_said_once(succeeded(pass.arguments_here()).log, "both pulses and coded frames");
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
  EXPECT_EQ(count_rows(pass.db, "pulse"), 3600);
  EXPECT_EQ(count_rows(pass.db, "pulse_use WHERE rejected_by = 'late'"), 0);
}

TEST(Process, ThatIsInterruptedSaysSoAndLeavesARunThatIsNotFinished) {
  const PassCopy pass{"nominal"};
  // The pass is repeated so often that the program cannot finish before the signal.
  const auto lines = lines_of(text_of(kPasses / "nominal" / "pulses.csv"));
  std::string often = lines[0] + "\n";
  for (std::int64_t again = 0; again < 500; ++again) {
    for (std::size_t i = 1; i < lines.size(); ++i) {
      often += later_row(lines[i], again * 600'000'000'000) + "\n";
    }
  }
  pass.folder.write("pulses.csv", often);
  Program program{pass.arguments_here()};
  ASSERT_TRUE(eventually([&] {
    return std::filesystem::exists(pass.db) &&
           count_rows(pass.db, "sqlite_schema WHERE name = 'pulse_use'") == 1 &&
           count_rows(pass.db, "spin_estimate") > 0;
  }));
  program.signal(SIGINT);
  EXPECT_EQ(program.exit_status(), 1) << program.log();
  const auto run = nlohmann::json::parse(program.out())["runs"][0];
  EXPECT_EQ(run["finished"], false);
  EXPECT_EQ(run["edges_received"], count_rows(pass.db, "pulse"));
  EXPECT_EQ(count_rows(pass.db, "pass_verdict WHERE finished = 0"), 1);
  EXPECT_GT(count_rows(pass.db, "pass_answer WHERE finished = 0"), 0);
}

}  // namespace spindrift::process_test
