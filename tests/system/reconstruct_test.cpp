#include <SQLiteCpp/Database.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/altered_text.h"
#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::reconstruct_test {

std::filesystem::path pass_of(const std::string& name) { return test_data() / "three-axis" / name; }

/// Returns the answer of a reconstruction that is expected to succeed.
nlohmann::json solved(const Words& words) {
  return succeeded(with({"reconstruct", "--json"}, words)).json();
}

/// Returns the error of one that is expected to be refused.
std::string error_of(const Words& words) {
  return refused(with({"reconstruct", "--json"}, words), {}).json()["error"];
}

nlohmann::json from_files(const std::filesystem::path& pass, const std::filesystem::path& db) {
  return solved({"--mission", pass / "mission.toml", "--telemetry", pass, "--db", db});
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

TEST(Reconstruct, OfARecordedSeparationIsRightAndStoredAndTheSameFromTheArchive) {
  const TemporaryFolder folder;
  const auto pass = pass_of("separation");
  const auto db = folder.path() / "out.db";
  const auto answer = from_files(pass, db);
  const auto& batch = answer["batch"];
  for (const std::size_t event : {0U, 1U}) {
    EXPECT_LT(off_deg(batch, pass, event), 0.8);
    EXPECT_LT(off_deg(batch, pass, event), 3.0 * batch["events"][event]["sigma_deg"].get<double>());
  }
  EXPECT_EQ(batch["quality"], "OK");
  EXPECT_LT(off_deg(answer["sequential"], pass, 0), 5.0);
  EXPECT_THAT(rows_of(db,
                      "SELECT mode, finished_utc IS NOT NULL, length(telemetry_sha256), telemetry "
                      "FROM run JOIN run_telemetry USING (run_id)"),
              ElementsAre("process|1|64|" + pass.string() + "|"));
  EXPECT_THAT(rows_of(db, "SELECT method FROM separation_verdict"), ElementsAre("batch|"));
  EXPECT_THAT(rows_of(db,
                      "SELECT method, event, found, euler312_orbit_deg_1 IS NOT NULL, bound_deg IS "
                      "NOT NULL FROM reconstruction_event"),
              ElementsAre("batch|T1|0|1|1|", "batch|T2|0|1|1|", "batch|T3|0|1|1|",
                          "batch|T4|0|1|1|", "sequential|T1|0|1|0|", "sequential|T2|0|1|0|",
                          "sequential|T3|0|1|0|", "sequential|T4|0|1|0|"));
  EXPECT_EQ(count_rows(db, "attitude WHERE source = 'batch'"),
            batch["attitudes"].get<std::int64_t>());
  EXPECT_EQ(count_rows(db, "gyro_sample"), 961);

  const Processed processed{pass};
  const auto archive = solved({"--mission", pass / "mission.toml", "--db", processed.db});
  EXPECT_EQ(archive["batch"], batch);
  EXPECT_EQ(archive["sequential"], answer["sequential"]);
  EXPECT_EQ(count_rows(processed.db, "run"), 2);
}

TEST(Reconstruct, FromTheArchiveLeavesOutWhatAnOperatorExcluded) {
  const Processed processed{pass_of("separation")};
  const auto before = solved({"--db", processed.db, "--method", "batch"});
  const auto& sun = before["batch"]["sun"]["count"];
  ASSERT_GT(sun.get<int>(), 100);
  SQLite::Database{processed.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "INSERT INTO operator_action SELECT 'a', spacecraft_id, run_id, first_arrival, first_tai_ns, "
      "started_utc, 'shift', 'exclude_channel', '{\"channel\":\"sun\"}', '' FROM run WHERE "
      "first_tai_ns IS NOT NULL");
  // The second time, the run contains the results of a reconstruction.
  for (int again = 0; again < 2; ++again) {
    const auto answer = solved({"--db", processed.db, "--method", "batch"});
    EXPECT_EQ(answer["batch"]["sun"]["count"], 0);
    EXPECT_GT(answer["batch"]["events"][0]["sigma_deg"].get<double>(),
              2.0 * before["batch"]["events"][0]["sigma_deg"].get<double>());
  }
}

TEST(Reconstruct, TakesTheMissionOfTheNewestRunWhereNoneIsGiven) {
  const auto pass = pass_of("juno");
  const Processed processed{pass};
  const auto answer = solved({"--db", processed.db, "--method", "batch"});
  EXPECT_LT(off_deg(answer["batch"], pass, 0), 0.01);
  EXPECT_TRUE(answer["sequential"].is_null());
}

/// The rates flown by Dawn: 59 minutes, a rotation of 72 deg, no orbit.
TEST(Reconstruct, OfTheRatesThatDawnFlewIsWhereItWas) {
  const TemporaryFolder folder;
  const auto pass = pass_of("dawn-2015");
  const auto answer = from_files(pass, folder.path() / "out.db");
  for (const char* const method : {"batch", "sequential"}) {
    const auto& separation = answer[method]["events"][0];
    const double error_deg = off_deg(answer[method], pass, 0);
    EXPECT_LT(error_deg, 0.05) << method;
    EXPECT_LT(error_deg, 3.0 * separation["sigma_deg"].get<double>()) << method;
    EXPECT_TRUE(separation["euler312_orbit_deg"].is_null()) << method;
  }
}

TEST(Reconstruct, WhereTheOrbitFileOfTheRunIsGoneAMissionIsAskedFor) {
  const TemporaryFolder folder;
  const auto pass = folder.path() / "pass";
  std::filesystem::copy(pass_of("separation"), pass);
  const Processed processed{pass};
  const auto found = solved({"--db", processed.db, "--method", "batch"});
  EXPECT_FALSE(found["batch"]["events"][0]["euler312_orbit_deg"].is_null());
  std::filesystem::remove(pass / "orbit.oem");
  EXPECT_THAT(error_of({"--db", processed.db}), HasSubstr("give --mission"));
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
  const Ran program = succeeded({"reconstruct", "--mission", mission, "--telemetry", pass, "--db",
                                 folder.path() / "out.db", "--plot", plot});
  EXPECT_THAT(program.out, HasSubstr("T4 first star fix       2026-03-01T04:05:00.000Z  found"));
  EXPECT_THAT(program.out, HasSubstr("batch: 0.153 deg apart at T1"));
  EXPECT_THAT(program.out, HasSubstr("of 3 degrees of freedom: inside 99 %"));
  EXPECT_THAT(text_of(plot), HasSubstr(">T4</text>"));
  EXPECT_EQ(number_of(folder.path() / "out.db",
                      "SELECT launcher_chance > 0.99 FROM reconstruction WHERE method = 'batch'"),
            1);
}

TEST(Reconstruct, IsRefusedBeforeAnythingIsWrittenWhereItCannotBe) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  const auto without_fix = pass_of("separation");
  EXPECT_THAT(error_of({"--mission", without_fix / "mission.toml", "--telemetry",
                        without_fix / "gyro.csv", "--db", db}),
              HasSubstr("samples up to the first one are needed"));
  const auto pass = pass_of("juno");
  const auto mission = folder.write(
      "mission.toml",
      replaced(text_of(pass / "mission.toml"),
               {{"t4_tai_ns = 1472285980053380864", "t4_tai_ns = 1472285880053380864"}}));
  EXPECT_THAT(error_of({"--mission", mission, "--telemetry", pass, "--db", db}),
              HasSubstr("t4_tai_ns = 1472285880053380864: must not be below"));
  EXPECT_THAT(error_of({"--mission", kPasses / "gms5" / "mission.toml", "--db", db}),
              HasSubstr("must be \"three_axis\" for this command"));
  EXPECT_FALSE(std::filesystem::exists(db));
}

}  // namespace spindrift::reconstruct_test
