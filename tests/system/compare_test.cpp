#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::compare_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kNominal = (scenarios() / "gto-nominal.toml").string();
const std::string kUpperStage = (scenarios() / "upper-stage.toml").string();

std::filesystem::path simulated(const TemporaryFolder& folder, const std::string& scenario) {
  const auto out = folder.path() / "pass";
  Program program{{"simulate", scenario, "--out", out.string()}};
  EXPECT_EQ(program.exit_status(), 0) << program.log();
  return out;
}

/// Simulates the nominal scenario with a slightly higher spin rate.
std::filesystem::path faster_pass(const TemporaryFolder& folder) {
  std::string text = text_of(kNominal);
  const std::string rate = "rate_rpm = 60.0";
  const auto at = text.find(rate);
  EXPECT_NE(at, std::string::npos);
  return simulated(
      folder,
      folder.write("faster.toml", text.replace(at, rate.size(), "rate_rpm = 60.1")).string());
}

nlohmann::json compared(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "compare");
  arguments.emplace_back("--json");
  Program program{std::move(arguments)};
  EXPECT_EQ(program.exit_status(), 0) << program.log();
  return nlohmann::json::parse(program.out());
}

TEST(Compare, FindsNoDepartureOfAPassFromItsScenario) {
  const TemporaryFolder folder;
  const auto pass = simulated(folder, kNominal);
  const auto plot = folder.path() / "plot.svg";
  const auto json = compared({"--mission", (pass / "mission.toml").string(), "--telemetry",
                              pass.string(), "--model", kNominal, "--plot", plot.string()});
  EXPECT_TRUE(json["first_departure"].is_null());
  EXPECT_TRUE(json["run_id"].is_null());
  EXPECT_EQ(json["channels"].size(), 7U);
  for (const auto& channel : json["channels"]) {
    if (channel["unit"] != "") {
      EXPECT_EQ(channel["samples"], 599) << channel;
      EXPECT_NEAR(channel["normalised_rms"], 1.0, 0.2) << channel;
    }
  }
  EXPECT_THAT(text_of(plot),
              AllOf(HasSubstr("<svg"), HasSubstr("period, s: flight, and the model")));
}

TEST(Compare, StoresADepartureInTheArchiveAsAnAlert) {
  const TemporaryFolder folder;
  const auto pass = faster_pass(folder);
  const auto db = (folder.path() / "pass.db").string();
  const auto mission = (pass / "mission.toml").string();
  Program process{{"process", "--mission", mission, "--telemetry", pass.string(), "--db", db}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();

  const auto json = compared({"--mission", mission, "--db", db, "--model", kNominal});
  EXPECT_EQ(json["first_departure"], "period");
  EXPECT_EQ(rows_of(db, "SELECT key, severity, state FROM alert WHERE key LIKE 'model.%'"),
            std::vector<std::string>{"model.departure:period|warning|active|"});
  const auto& departure = json["channels"][0]["departure"];
  EXPECT_NEAR(departure["value"], 1.0 - 60.0 / 60.1, 1e-3);
  EXPECT_NEAR(departure["limit"], 5.0 * std::sqrt(2.0) * 1e-4, 1e-9);
  EXPECT_EQ(number_of(db, "SELECT evidence ->> 'since_tai_ns' FROM alert WHERE key LIKE 'model.%'"),
            departure["since_tai_ns"].get<std::int64_t>());
  EXPECT_EQ(rows_of(db, "SELECT mode, finished_utc IS NOT NULL FROM run WHERE run_id = '" +
                            json["run_id"].get<std::string>() + "'"),
            std::vector<std::string>{"process|1|"});

  EXPECT_EQ(rows_of(db,
                    "SELECT channel, unit, samples, outside, departed_tai_ns FROM"
                    " model_comparison WHERE departed_tai_ns IS NOT NULL"),
            std::vector<std::string>{"period|s|599|599|" + departure["since_tai_ns"].dump() + "|"});
  EXPECT_EQ(number_of(db,
                      "SELECT count(*) FROM model_comparison WHERE (samples > 0) = (rms > 0)"
                      " OR (samples = 0 AND rms IS NULL)"),
            7);

  // The files give the same result, except for what depends on the archive.
  auto from_files =
      compared({"--mission", mission, "--telemetry", pass.string(), "--model", kNominal});
  EXPECT_EQ(from_files["channels"], json["channels"]);

  Program text{
      {"compare", "--mission", mission, "--telemetry", pass.string(), "--model", kNominal}};
  ASSERT_EQ(text.exit_status(), 0) << text.log();
  EXPECT_THAT(text.out(), HasSubstr("period          away since 2026-11-20T03:00:0"));
}

TEST(Compare, NamesTheSensorThatSendsNothing) {
  const TemporaryFolder folder;
  const auto pass = simulated(folder, kUpperStage);
  std::filesystem::remove(pass / "star.csv");
  const auto json = compared({"--mission", (pass / "mission.toml").string(), "--telemetry",
                              pass.string(), "--model", kUpperStage});
  EXPECT_EQ(json["first_departure"], "star");
  for (const auto& channel : json["channels"]) {
    EXPECT_EQ(!channel["departure"].is_null(), channel["channel"] == "star") << channel;
  }
}

TEST(Compare, IsMadeByProcessWhereTheMissionNamesAScenario) {
  const TemporaryFolder folder;
  const auto pass = faster_pass(folder);
  const auto mission = pass / "mission.toml";
  std::filesystem::copy_file(kNominal, pass / "model.toml");
  std::ofstream{mission, std::ios::app} << "\n[ground_model]\nscenario = \"model.toml\"\n";
  const auto db = (folder.path() / "pass.db").string();
  Program process{
      {"process", "--mission", mission.string(), "--telemetry", pass.string(), "--db", db}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();
  const auto json =
      compared({"--mission", mission.string(), "--telemetry", pass.string(), "--model", kNominal});
  EXPECT_EQ(
      rows_of(db,
              "SELECT key, state, evidence ->> 'since_tai_ns' FROM alert WHERE key LIKE"
              " 'model.%'"),
      std::vector<std::string>{"model.departure:period|active|" +
                               json["channels"][0]["departure"]["since_tai_ns"].dump() + "|"});

  std::filesystem::remove(pass / "model.toml");
  Program refused{
      {"process", "--mission", mission.string(), "--telemetry", pass.string(), "--db", db}};
  EXPECT_EQ(refused.exit_status(), 2);
  EXPECT_THAT(refused.log(), HasSubstr("model.toml"));
}

void expect_refused(std::vector<std::string> arguments, const std::string& why) {
  arguments.insert(arguments.begin(), "compare");
  Program program{std::move(arguments)};
  EXPECT_EQ(program.exit_status(), 2);
  EXPECT_THAT(program.log(), HasSubstr(why));
  EXPECT_EQ(program.out(), "");
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const TemporaryFolder folder;
  const auto pass = simulated(folder, kNominal);
  const auto mission = (pass / "mission.toml").string();
  expect_refused({"--mission", mission, "--telemetry", pass.string(), "--model", kUpperStage},
                 "spacecraft.id = \"SMALLSAT\": must be \"SPINNER\"");
  expect_refused({"--mission", mission, "--model", kNominal}, "--telemetry");
  expect_refused(
      {"--mission", mission, "--telemetry", pass.string(), "--db", "pass.db", "--model", kNominal},
      "--db");
  expect_refused(
      {"--mission", mission, "--db", (folder.path() / "none.db").string(), "--model", kNominal},
      "none.db");
  std::string later = text_of(kNominal);
  const std::string start = "2026-11-20T03:00:00Z";
  later.replace(later.find("start_utc = \"" + start) + 13, start.size(), "2026-11-20T05:00:00Z");
  expect_refused({"--mission", mission, "--telemetry", pass.string(), "--model",
                  folder.write("later.toml", later).string()},
                 "no sample of SPINNER from 2026-11-20T05:00:0");
}

}  // namespace spindrift::compare_test
