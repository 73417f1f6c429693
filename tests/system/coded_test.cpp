#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/service.h"
#include "tests/support/test_paths.h"

namespace spindrift::coded_test {

const std::filesystem::path kPass = recorded_passes() / "coded";
const std::string kMission = (kPass / "mission.toml").string();
const std::filesystem::path kScenarios = scenarios();
const std::string kScenario = (kScenarios / "gto-nominal.toml").string();
const std::string kDirty = (kScenarios / "gto-dirty.toml").string();

std::vector<std::string> on(const bus::BusConfig& bus, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(),
                   {"--domain", std::to_string(bus.domain), "--partition", bus.partition});
  return arguments;
}

/// Runs `serve` on what the program `source` publishes.
void serve(const std::string& mission, const std::filesystem::path& db,
           const std::vector<std::string>& source) {
  const bus::BusConfig bus = bus_of_its_own();
  serve_whole(on(bus, {"serve", "--mission", mission, "--db", db.string()}), [&] {
    Program sending{on(bus, source)};
    ASSERT_EQ(sending.exit_status(), 0) << sending.log();
  });
}

void process(const std::string& mission, const std::filesystem::path& telemetry,
             const std::filesystem::path& db) {
  Program program{{"process", "--mission", mission, "--telemetry", telemetry.string(), "--db",
                   db.string(), "--strict"}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
}

std::vector<std::string> coded_rows(const std::filesystem::path& db) {
  return rows_of(db,
                 "SELECT spacecraft_id, t_tai_ns, period_s, sun2_s, north_in_s, north_out_s,"
                 " south_in_s, south_out_s FROM coded_frame ORDER BY 1, 2");
}

double error_deg(const std::filesystem::path& db, const std::string& estimator,
                 const nlohmann::json& truth) {
  const std::string answer = " FROM pass_answer WHERE estimator = '" + estimator + "'";
  const auto place = [](double ra_deg, double dec_deg) {
    return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
  };
  return angle_between_rad(
             place(real_of(db, "SELECT ra_deg" + answer), real_of(db, "SELECT dec_deg" + answer)),
             place(truth["ra_deg"], truth["dec_deg"])) /
         kRadPerDeg;
}

TEST(Coded, GivesTheSameProductsLiveAsOfflineAndFindsTheAxis) {
  const TemporaryFolder folder;
  const auto offline = folder.path() / "processed.db";
  const auto served = folder.path() / "served.db";
  process(kMission, kPass, offline);
  serve(kMission, served,
        {"replay", "--mission", kMission, "--telemetry", kPass.string(), "--speed", "0"});
  const auto rows = product_rows(offline);
  EXPECT_GT(rows.size(), 4000U);
  EXPECT_EQ(product_rows(served), rows);
  EXPECT_EQ(last_batch_rows(served), last_batch_rows(offline));
  EXPECT_EQ(coded_rows(offline).size(), 299U);
  EXPECT_EQ(coded_rows(served), coded_rows(offline));

  const auto truth = nlohmann::json::parse(text_of(kPass / "truth.json"));
  for (const std::string estimator : {"mean", "sequential"}) {
    EXPECT_LT(error_deg(offline, estimator, truth), 0.1) << estimator;
  }
}

TEST(Coded, SimulatedPassGivesTheSameProductsFromTheBusAsFromFiles) {
  const TemporaryFolder folder;
  const std::string scenario =
      folder.write("scenario.toml", text_of(kScenario) + "[telemetry]\nkind = \"coded\"\n")
          .string();
  const auto pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario, "--out", pass.string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  const std::string mission = (pass / "mission.toml").string();
  const auto offline = folder.path() / "processed.db";
  const auto served = folder.path() / "served.db";
  process(mission, pass, offline);
  serve(mission, served, {"simulate", scenario, "--publish", "--speed", "0"});
  EXPECT_EQ(coded_rows(offline).size(), 600U);
  EXPECT_EQ(product_rows(served), product_rows(offline));
}

/// The drift changes the period by a hundred times its noise each turn.
TEST(Coded, FramesOfASlowBodyThatDriftsAreTakenFromTheFirstTurns) {
  for (const std::string drift_rpm_h : {"0.5", "1.0", "2.0"}) {
    SCOPED_TRACE(drift_rpm_h);
    const TemporaryFolder folder;
    std::string scenario = text_of(kScenario) + "[telemetry]\nkind = \"coded\"\n";
    const std::string rate = "rate_rpm = 60.0\n";
    scenario.replace(scenario.find(rate), rate.size(),
                     "rate_rpm = 5.5\nrate_drift_rpm_h = " + drift_rpm_h + "\n");
    const auto pass = folder.path() / "pass";
    Program simulate{
        {"simulate", folder.write("scenario.toml", scenario).string(), "--out", pass.string()}};
    ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
    const auto db = folder.path() / "processed.db";
    process((pass / "mission.toml").string(), pass, db);
    EXPECT_GT(real_of(db, "SELECT avg(accepted) FROM pulse_use"), 0.9);
    // There is one frame a turn, and every turn is counted.
    EXPECT_EQ(number_of(db, "SELECT max(revolution) - min(revolution) + 1 FROM revolution"),
              number_of(db, "SELECT count(*) FROM coded_frame") - 1);
    EXPECT_EQ(number_of(db, "SELECT count(*) FROM pass_answer WHERE quality = 'OK'"), 3);
    const auto truth = nlohmann::json::parse(text_of(pass / "truth.json"));
    for (const std::string estimator : {"mean", "sequential", "batch"}) {
      EXPECT_LT(error_deg(db, estimator, truth), 0.06) << estimator;
    }
  }
}

TEST(Coded, SimulatedPassWithASilenceAndEveryFaultIsTelemetryThatCanBeTrue) {
  const TemporaryFolder folder;
  const std::string scenario =
      folder.write("scenario.toml", text_of(kDirty) + "[telemetry]\nkind = \"coded\"\n").string();
  const auto pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario, "--out", pass.string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  const auto db = folder.path() / "processed.db";
  process((pass / "mission.toml").string(), pass, db);
  // 12 s are 12 turns at 60 rpm: so many consecutive sun1 are never lost, but the silence lasts a
  // minute.
  EXPECT_LT(real_of(db, "SELECT max(period_s) FROM coded_frame"), 12.0);
}

TEST(Coded, SimulatedPassOfBothKindsIsPublishedAsBoth) {
  const TemporaryFolder folder;
  const std::string scenario =
      folder.write("scenario.toml", text_of(kScenario) + "[telemetry]\nkind = \"both\"\n").string();
  const auto pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario, "--out", pass.string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  const auto served = folder.path() / "served.db";
  serve((pass / "mission.toml").string(), served,
        {"simulate", scenario, "--publish", "--speed", "0"});
  EXPECT_EQ(number_of(served, "SELECT count(*) FROM pulse"), 3600);
  EXPECT_EQ(number_of(served, "SELECT count(*) FROM coded_frame"), 600);
}

TEST(Coded, SummaryCountsFramesAndTheEdgesInThem) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "out.db";
  Program program{{"process", "--mission", kMission, "--telemetry", kPass.string(), "--db",
                   db.string(), "--json"}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  const auto run = nlohmann::json::parse(program.out())["runs"][0];
  EXPECT_EQ(run["coded_frames_received"], 299);
  const std::int64_t edges = number_of(
      db,
      "SELECT sum(1 + (sun2_s IS NOT NULL) + (north_in_s IS NOT NULL) + (north_out_s IS NOT NULL)"
      " + (south_in_s IS NOT NULL) + (south_out_s IS NOT NULL)) FROM coded_frame");
  EXPECT_GT(edges, 5 * 299);
  EXPECT_EQ(run["edges_received"], edges);
  EXPECT_EQ(run["edges_stored"], edges);
  EXPECT_EQ(run["edges_accepted"], number_of(db, "SELECT sum(accepted) FROM pulse_use"));
}

}  // namespace spindrift::coded_test
