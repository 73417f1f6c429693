#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/archive_rows.h"
#include "tests/support/processed_pass.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::reconstruct_test {

using ::testing::HasSubstr;

std::filesystem::path pass_of(const std::string& name) { return test_data() / "three-axis" / name; }

struct Answer {
  int status;
  nlohmann::json object;
  std::string log;
};

Answer reconstruct(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "reconstruct");
  arguments.emplace_back("--json");
  Program program{std::move(arguments)};
  const int status = program.exit_status();
  return {.status = status, .object = nlohmann::json::parse(program.out()), .log = program.log()};
}

Answer from_files(const std::filesystem::path& pass, const std::filesystem::path& db) {
  return reconstruct({"--mission", (pass / "mission.toml").string(), "--telemetry", pass.string(),
                      "--db", db.string()});
}

double off_deg(const nlohmann::json& solution, const std::filesystem::path& pass,
               std::size_t event) {
  const auto& one = solution["events"][event];
  const auto truth = nlohmann::json::parse(text_of(pass / "truth.json"));
  const auto q =
      truth[one["event"].get<std::string>()]["q_icrf_body_xyzw"].get<std::vector<double>>();
  return angle_between_rad(Eigen::Quaterniond{one["qw"], one["qx"], one["qy"], one["qz"]},
                           Eigen::Quaterniond{q.data()}) /
         kRadPerDeg;
}

TEST(Reconstruct, OfARecordedSeparationIsRightAndStored) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const auto db = folder.path() / "out.db";
  const Answer answer = from_files(pass, db);
  ASSERT_EQ(answer.status, 0) << answer.log;
  const auto& batch = answer.object["batch"];
  for (const std::size_t event : {0U, 1U}) {
    EXPECT_LT(off_deg(batch, pass, event), 0.8);
    EXPECT_LT(off_deg(batch, pass, event), 3.0 * batch["events"][event]["sigma_deg"].get<double>());
  }
  EXPECT_EQ(batch["quality"], "OK");
  EXPECT_LT(off_deg(answer.object["sequential"], pass, 0), 5.0);
  EXPECT_EQ(rows_of(db,
                    "SELECT mode, finished_utc IS NOT NULL, length(telemetry_sha256),"
                    " telemetry FROM run JOIN run_telemetry USING (run_id)"),
            std::vector<std::string>{"process|1|64|" + pass.string() + "|"});
  EXPECT_EQ(rows_of(db, "SELECT method FROM separation_verdict"),
            std::vector<std::string>{"batch|"});
  EXPECT_EQ(
      rows_of(db,
              "SELECT method, event, found, euler312_orbit_deg_1 IS NOT NULL,"
              " bound_deg IS NOT NULL FROM reconstruction_event"),
      (std::vector<std::string>{"batch|T1|0|1|1|", "batch|T2|0|1|1|", "batch|T3|0|1|1|",
                                "batch|T4|0|1|1|", "sequential|T1|0|1|0|", "sequential|T2|0|1|0|",
                                "sequential|T3|0|1|0|", "sequential|T4|0|1|0|"}));
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM attitude WHERE source = 'batch'"),
            batch["attitudes"].get<std::int64_t>());
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM gyro_sample"), 961);
}

TEST(Reconstruct, FromTheArchiveGivesWhatTheFilesGive) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const Answer files = from_files(pass, folder.path() / "files.db");
  const Outcome processed = process(folder, pass);
  ASSERT_EQ(processed.status, 0) << processed.log;
  const Answer archive =
      reconstruct({"--mission", (pass / "mission.toml").string(), "--db", processed.db.string()});
  ASSERT_EQ(archive.status, 0) << archive.log;
  EXPECT_EQ(archive.object["batch"], files.object["batch"]);
  EXPECT_EQ(archive.object["sequential"], files.object["sequential"]);
  EXPECT_EQ(number_of(processed.db, "SELECT count(*) FROM run"), 2);
}

TEST(Reconstruct, FromTheArchiveLeavesOutWhatAnOperatorExcluded) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const Outcome processed = process(folder, pass);
  ASSERT_EQ(processed.status, 0) << processed.log;
  const Answer before = reconstruct({"--db", processed.db.string(), "--method", "batch"});
  ASSERT_EQ(before.status, 0) << before.log;
  const auto& sun = before.object["batch"]["sun"]["count"];
  ASSERT_GT(sun.get<int>(), 100);
  SQLite::Database{processed.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "INSERT INTO operator_action SELECT 'a', spacecraft_id, run_id, first_arrival, first_tai_ns,"
      " started_utc, 'shift', 'exclude_channel', '{\"channel\":\"sun\"}', '' FROM run"
      " WHERE first_tai_ns IS NOT NULL");
  // The second time, the run contains the results of a reconstruction.
  for (int again = 0; again < 2; ++again) {
    const Answer answer = reconstruct({"--db", processed.db.string(), "--method", "batch"});
    ASSERT_EQ(answer.status, 0) << answer.log;
    EXPECT_EQ(answer.object["batch"]["sun"]["count"], 0);
    EXPECT_GT(answer.object["batch"]["events"][0]["sigma_deg"].get<double>(),
              2.0 * before.object["batch"]["events"][0]["sigma_deg"].get<double>());
  }
}

TEST(Reconstruct, TakesTheMissionOfTheNewestRunWhereNoneIsGiven) {
  const TemporaryFolder folder;
  const auto pass = pass_of("juno");
  const Outcome processed = process(folder, pass);
  ASSERT_EQ(processed.status, 0) << processed.log;
  const Answer answer = reconstruct({"--db", processed.db.string(), "--method", "batch"});
  ASSERT_EQ(answer.status, 0) << answer.log;
  EXPECT_LT(off_deg(answer.object["batch"], pass, 0), 0.01);
  EXPECT_TRUE(answer.object["sequential"].is_null());
}

/// The rates flown by Dawn: 59 minutes, a rotation of 72 deg, no orbit.
TEST(Reconstruct, OfTheRatesThatDawnFlewIsWhereItWas) {
  const TemporaryFolder folder;
  const auto pass = pass_of("dawn-2015");
  const Answer answer = from_files(pass, folder.path() / "out.db");
  ASSERT_EQ(answer.status, 0) << answer.log;
  for (const char* const method : {"batch", "sequential"}) {
    const auto& separation = answer.object[method]["events"][0];
    const double error_deg = off_deg(answer.object[method], pass, 0);
    EXPECT_LT(error_deg, 0.05) << method;
    EXPECT_LT(error_deg, 3.0 * separation["sigma_deg"].get<double>()) << method;
    EXPECT_TRUE(separation["euler312_orbit_deg"].is_null()) << method;
  }
}

TEST(Reconstruct, WhereTheOrbitFileOfTheRunIsGoneAMissionIsAskedFor) {
  const TemporaryFolder folder;
  const auto pass = folder.path() / "pass";
  std::filesystem::copy(pass_of("separation"), pass);
  const Outcome processed = process(folder, pass);
  const Answer found = reconstruct({"--db", processed.db.string(), "--method", "batch"});
  ASSERT_EQ(found.status, 0) << found.log;
  EXPECT_FALSE(found.object["batch"]["events"][0]["euler312_orbit_deg"].is_null());
  std::filesystem::remove(pass / "orbit.oem");
  const Answer answer = reconstruct({"--db", processed.db.string()});
  EXPECT_EQ(answer.status, 2);
  EXPECT_THAT(answer.object["error"], HasSubstr("give --mission"));
}

TEST(Reconstruct, SaysWhatTheLauncherIsOffByAndWhichEventsWereFound) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const std::string toml = replaced(
      text_of(pass / "mission.toml"),
      {{"oem = \"orbit.oem\"", "oem = \"" + (pass / "orbit.oem").string() + "\""},
       {"t3_tai_ns = 1772337715000000000", ""},
       {"t4_tai_ns = 1772337937000000000",
        "[reconstruction.launcher]\neuler312_deg = [51.9, -61.3, 112.6]\nsigma_deg = 0.5"}});
  const auto mission = folder.write("mission.toml", toml);
  const auto plot = folder.path() / "plot.svg";
  Program program{{"reconstruct", "--mission", mission.string(), "--telemetry", pass.string(),
                   "--db", (folder.path() / "out.db").string(), "--plot", plot.string()}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_THAT(program.out(), HasSubstr("T4 first star fix       2026-03-01T04:05:00.000Z  found"));
  EXPECT_THAT(program.out(), HasSubstr("batch: 0.0"));
  EXPECT_THAT(program.out(), HasSubstr("of 3 degrees of freedom: inside 99 %"));
  EXPECT_THAT(text_of(plot), HasSubstr(">T4</text>"));
  EXPECT_EQ(number_of(folder.path() / "out.db",
                      "SELECT launcher_chance > 0.99 FROM reconstruction WHERE method = 'batch'"),
            1);
}

TEST(Reconstruct, WithoutAStarFixIsRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const auto db = folder.path() / "out.db";
  const Answer answer = reconstruct({"--mission", (pass / "mission.toml").string(), "--telemetry",
                                     (pass / "gyro.csv").string(), "--db", db.string()});
  EXPECT_EQ(answer.status, 2);
  EXPECT_THAT(answer.object["error"], HasSubstr("samples up to the first one are needed"));
  EXPECT_FALSE(std::filesystem::exists(db));
}

TEST(Reconstruct, WithEventsOutOfOrderIsRefused) {
  const TemporaryFolder folder;
  const auto pass = pass_of("juno");
  const auto mission = folder.write(
      "mission.toml",
      replaced(text_of(pass / "mission.toml"),
               {{"t4_tai_ns = 1472285980053380864", "t4_tai_ns = 1472285880053380864"}}));
  const Answer answer = reconstruct({"--mission", mission.string(), "--telemetry", pass.string(),
                                     "--db", (folder.path() / "out.db").string()});
  EXPECT_EQ(answer.status, 2);
  EXPECT_THAT(answer.object["error"],
              HasSubstr("t4_tai_ns = 1472285880053380864: must not be below"));
}

TEST(Reconstruct, OfASpinnerIsRefused) {
  const TemporaryFolder folder;
  const Answer answer =
      reconstruct({"--mission", (test_data() / "spin" / "gms5" / "mission.toml").string(), "--db",
                   (folder.path() / "out.db").string()});
  EXPECT_EQ(answer.status, 2);
  EXPECT_THAT(answer.object["error"], HasSubstr("must be \"three_axis\" for this command"));
}

}  // namespace spindrift::reconstruct_test
