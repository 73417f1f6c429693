#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::compare_test {

const std::string kNominal = (scenarios() / "gto-nominal.toml").string();
const std::string kUpperStage = (scenarios() / "upper-stage.toml").string();

/// The nominal scenario with a slightly higher spin rate.
const Replacements kFaster{{"rate_rpm = 60.0", "rate_rpm = 60.1"}};

Words compare(const Words& words) { return with({"compare"}, words); }

nlohmann::json compared(const Words& words) {
  return succeeded(with(compare(words), {"--json"})).json();
}

TEST(Compare, FindsNoDepartureOfAPassFromItsScenario) {
  const Simulated simulated{"gto-nominal.toml"};
  const auto plot = simulated.folder.path() / "plot.svg";
  const auto json = compared({"--mission", simulated.mission(), "--telemetry", simulated.pass,
                              "--model", kNominal, "--plot", plot});
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
  const Simulated simulated{"gto-nominal.toml", kFaster};
  const auto& pass = simulated.pass;
  const std::string mission = simulated.mission();
  const Processed processed{pass};
  const auto& db = processed.db;
  const auto json = compared({"--mission", mission, "--db", db, "--model", kNominal});
  EXPECT_EQ(json["first_departure"], "period");
  EXPECT_THAT(rows_of(db, "SELECT key, severity, state FROM alert WHERE key LIKE 'model.%'"),
              ElementsAre("model.departure:period|warning|active|"));
  const auto& departure = json["channels"][0]["departure"];
  EXPECT_NEAR(departure["value"], 1.0 - 60.0 / 60.1, 1e-3);
  EXPECT_NEAR(departure["limit"], 5.0 * std::sqrt(2.0) * 1e-4, 1e-9);
  EXPECT_EQ(number_of(db, "SELECT evidence ->> 'since_tai_ns' FROM alert WHERE key LIKE 'model.%'"),
            departure["since_tai_ns"].get<std::int64_t>());
  EXPECT_THAT(rows_of(db, "SELECT mode, finished_utc IS NOT NULL FROM run WHERE run_id = '" +
                              json["run_id"].get<std::string>() + "'"),
              ElementsAre("process|1|"));

  EXPECT_THAT(rows_of(db,
                      "SELECT channel, unit, samples, outside, departed_tai_ns FROM "
                      "model_comparison WHERE departed_tai_ns IS NOT NULL"),
              ElementsAre("period|s|599|599|" + departure["since_tai_ns"].dump() + "|"));
  EXPECT_EQ(
      count_rows(
          db, "model_comparison WHERE (samples > 0) = (rms > 0) OR (samples = 0 AND rms IS NULL)"),
      7);

  // The files give the same result, except for what depends on the archive.
  const Words files{"--mission", mission, "--telemetry", pass, "--model", kNominal};
  EXPECT_EQ(compared(files)["channels"], json["channels"]);
  EXPECT_THAT(succeeded(compare(files)).out,
              HasSubstr("period          away since 2026-11-20T03:00:0"));
}

TEST(Compare, NamesTheSensorThatSendsNothing) {
  const Simulated simulated{"upper-stage.toml"};
  std::filesystem::remove(simulated.pass / "star.csv");
  const auto json = compared(
      {"--mission", simulated.mission(), "--telemetry", simulated.pass, "--model", kUpperStage});
  EXPECT_EQ(json["first_departure"], "star");
  for (const auto& channel : json["channels"]) {
    EXPECT_EQ(!channel["departure"].is_null(), channel["channel"] == "star") << channel;
  }
}

TEST(Compare, IsMadeByProcessWhereTheMissionNamesAScenario) {
  const Simulated simulated{"gto-nominal.toml", kFaster};
  const auto& pass = simulated.pass;
  const std::string mission = simulated.mission();
  std::filesystem::copy_file(kNominal, pass / "model.toml");
  std::ofstream{mission, std::ios::app} << "\n[ground_model]\nscenario = \"model.toml\"\n";
  const Processed processed{pass};
  const auto& db = processed.db;
  const auto json = compared({"--mission", mission, "--telemetry", pass, "--model", kNominal});
  EXPECT_THAT(
      rows_of(db,
              "SELECT key, state, evidence ->> 'since_tai_ns' FROM alert WHERE key LIKE 'model.%'"),
      ElementsAre("model.departure:period|active|" +
                  json["channels"][0]["departure"]["since_tai_ns"].dump() + "|"));

  std::filesystem::remove(pass / "model.toml");
  refused({"process", "--mission", mission, "--telemetry", pass, "--db", db}, {"model.toml"});
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const Simulated simulated{"gto-nominal.toml"};
  const std::string mission = simulated.mission();
  const std::string telemetry = simulated.pass;
  const std::string later = simulated.folder.write(
      "later.toml", replaced(text_of(kNominal), {{"start_utc = \"2026-11-20T03:00:00Z",
                                                  "start_utc = \"2026-11-20T05:00:00Z"}}));
  for (const auto& [words, why] : std::vector<std::pair<Words, std::string>>{
           {{"--telemetry", telemetry, "--model", kUpperStage},
            "spacecraft.id = \"SMALLSAT\": must be \"SPINNER\""},
           {{"--model", kNominal}, "--telemetry"},
           {{"--telemetry", telemetry, "--db", "pass.db", "--model", kNominal}, "--db"},
           {{"--db", simulated.folder.path() / "none.db", "--model", kNominal}, "none.db"},
           {{"--telemetry", telemetry, "--model", later},
            "no sample of SPINNER from 2026-11-20T05:00:0"}}) {
    EXPECT_EQ(refused(with({"compare", "--mission", mission}, words), {why}).out, "");
  }
}

}  // namespace spindrift::compare_test
