#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/altered_text.h"
#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/lines.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"

namespace spindrift::simulate_test {

const std::filesystem::path kScenarios = scenarios();
const std::string kNominal = (kScenarios / "gto-nominal.toml").string();
const std::string kDirty = (kScenarios / "gto-dirty.toml").string();
const std::string kSeparation = (kScenarios / "separation.toml").string();
const std::string kTumbling = (kScenarios / "tumbling.toml").string();
const std::string kUpperStage = (kScenarios / "upper-stage.toml").string();

nlohmann::json truth_of(const std::filesystem::path& pass) {
  return nlohmann::json::parse(text_of(pass / "truth.json"));
}

std::vector<std::string> rows_in(const std::filesystem::path& csv) {
  return lines_of(text_of(csv));
}

/// Expects `process` to give more than `least` attitudes at the times of the true history, and none
/// that is off by more than four sigma.
void expect_true_attitudes(const std::filesystem::path& pass, int least) {
  const Processed processed{pass, {"--strict"}};
  int count = 0;
  const auto told = truth_of(pass);
  for (const auto& truth : told["history"]) {
    const std::string from =
        fmt::format("attitude WHERE t_tai_ns = {}", truth[0].get<std::int64_t>());
    const auto row = [&](const std::string& column) {
      return real_of(processed.db, "SELECT " + column + " FROM " + from);
    };
    if (count_rows(processed.db, from) == 1) {
      const double off_rad =
          angle_between_rad(Eigen::Quaterniond{row("qw"), row("qx"), row("qy"), row("qz")},
                            Eigen::Quaterniond{truth[4], truth[1], truth[2], truth[3]});
      EXPECT_LE(degrees(off_rad), 4.0 * row("sigma_deg")) << from;
      ++count;
    }
  }
  EXPECT_GT(count, least);
}

class Simulate : public ::testing::Test {
 protected:
  nlohmann::json simulated(const std::string& scenario) const { return simulated(scenario, out_); }
  static nlohmann::json simulated(const std::string& scenario, const std::filesystem::path& out) {
    const Ran program = succeeded({"simulate", scenario, "--out", out, "--json"});
    // Standard error is a file here, so no progress bar is drawn.
    EXPECT_EQ(program.log, "");
    return program.json();
  }

  /// Returns a delivered scenario with a replacement.
  std::string changed(const std::string& scenario, const std::string& from,
                      const std::string& to) const {
    return folder_.write("scenario.toml", replaced(text_of(scenario), {{from, to}}));
  }

  /// Runs a service on the mission of `out_` that receives `simulate --publish`.
  /// @return JSON output of `simulate`.
  nlohmann::json served(const std::string& scenario) const {
    const auto bus = bus_of_its_own();
    Serving service{on(bus, {"serve", "--mission", out_ / "mission.toml", "--db", db_})};
    const Ran publishing =
        succeeded(on(bus, {"simulate", scenario, "--publish", "--speed", "0", "--json"}));
    stop_in_order(service);
    return publishing.json();
  }

  TemporaryFolder folder_;
  std::filesystem::path out_ = folder_.path() / "pass";
  std::filesystem::path db_ = folder_.path() / "served.db";
};

TEST_F(Simulate, MakesAPassOfWhichTheAxisIsFound) {
  const auto out = out_ / "deep" / "pass";
  const auto summary = simulated(kNominal, out);
  EXPECT_EQ(summary["revolutions"], 600);
  EXPECT_EQ(summary["edges"], 3600);
  EXPECT_EQ(summary["spacecraft"], "SPINNER");
  EXPECT_EQ(summary["files"].size(), 4U);
  for (const auto& file : summary["files"]) {
    EXPECT_TRUE(std::filesystem::exists(file.get<std::string>())) << file;
  }

  const auto mean = Processed{out, {"--strict"}}.run["mean"];
  const auto truth = truth_of(out);
  // Three sigma of a two-dimensional error, where sigma covers both directions.
  EXPECT_LT(error_deg(mean, truth), 3.0 * mean["sigma_deg"].get<double>());
  EXPECT_NEAR(mean["spin_rate_rpm"], truth["rpm"], 4.0 * mean["sigma_rpm"].get<double>());
}

TEST_F(Simulate, TellsTheTruthAboutEveryFault) {
  const auto summary = simulated(kDirty);
  const auto truth = truth_of(out_);
  const auto rows = rows_in(out_ / "pulses.csv");

  EXPECT_EQ(summary["edges"], rows.size() - 1);
  const std::set<std::string> written{rows.begin(), rows.end()};
  std::map<std::string, int> counted;
  for (const auto& bad : truth["bad_edges"]) {
    EXPECT_TRUE(written.contains(std::to_string(bad[0].get<std::int64_t>()) + "," +
                                 bad[1].get<std::string>()))
        << bad;
    ++counted[bad[2]];
  }
  for (const char* const kind : {"spoilt", "spurious", "doubled", "interference"}) {
    EXPECT_GT(counted[kind], 0) << kind;
    EXPECT_EQ(truth[kind], counted[kind]) << kind;
    EXPECT_EQ(summary["faults"][kind], counted[kind]) << kind;
  }
  // Received edges consist of the 3600 true ones less the missing, plus spurious and doubled ones.
  const std::int64_t edges = summary["edges"];
  const std::int64_t missing = truth["missing"];
  EXPECT_EQ(edges + missing - counted["spurious"] - counted["doubled"], 3600);
}

TEST_F(Simulate, GivesTheSameBytesForTheSameSeed) {
  simulated(kDirty, folder_.path() / "a");
  simulated(kDirty, folder_.path() / "b");
  simulated(changed(kDirty, "seed = 7", "seed = 8"), folder_.path() / "c");
  for (const char* const name : {"pulses.csv", "orbit.oem", "mission.toml", "truth.json"}) {
    EXPECT_EQ(text_of(folder_.path() / "a" / name), text_of(folder_.path() / "b" / name)) << name;
  }
  EXPECT_NE(text_of(folder_.path() / "a" / "pulses.csv"),
            text_of(folder_.path() / "c" / "pulses.csv"));
}

TEST_F(Simulate, WritesCodedTelemetryOneRowARevolution) {
  simulated(changed(kNominal, "[attitude]",
                    "[telemetry]\nkind = \"both\"\ncoded_resolution_s = 1e-4\n[attitude]"));
  const auto rows = rows_in(out_ / "coded.csv");
  ASSERT_EQ(rows.size(), 601U);
  EXPECT_EQ(rows[0], "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s");
  std::vector<std::string> sun1;
  for (const std::string& row : rows_in(out_ / "pulses.csv")) {
    if (row.ends_with(",sun1")) {
      sun1.push_back(row.substr(0, row.find(',')));
    }
  }
  ASSERT_EQ(sun1.size(), 600U);
  for (std::size_t i = 0; i < sun1.size(); ++i) {
    EXPECT_THAT(rows[i + 1], StartsWith(sun1[i] + ","));
  }
  // One turn takes 1 s, given to 0.1 ms; only the first frame has no predecessor.
  EXPECT_THAT(rows[1], StartsWith(sun1[0] + ",,0."));
  EXPECT_THAT(rows[2],
              ::testing::AnyOf(StartsWith(sun1[1] + ",0.999"), StartsWith(sun1[1] + ",1")));
  EXPECT_THAT(rows[2], ::testing::ContainsRegex(R"(^[0-9]+(,[01](\.[0-9]{1,4})?){6}$)"));
}

TEST_F(Simulate, ReplacesItsOwnFilesButRefusesAFolderWithOtherTelemetry) {
  simulated(kDirty);
  simulated(kNominal);
  EXPECT_EQ(rows_in(out_ / "pulses.csv").size(), 3601U);

  std::ofstream{out_ / "other.csv"} << "t_tai_ns,channel\n";
  refused({"simulate", kDirty, "--out", out_}, {"other.csv: is not of this pass"});
  EXPECT_EQ(rows_in(out_ / "pulses.csv").size(), 3601U);
}

TEST_F(Simulate, LeavesNothingHalfWrittenOnAFullDisk) {
  Program program{{"simulate", kNominal, "--out", out_}, 32};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("pulses.csv: cannot be written: File too large"));
  EXPECT_TRUE(std::filesystem::is_empty(out_));
}

TEST_F(Simulate, RefusesABadFolderAndABadScenarioBeforeItWritesAnything) {
  const auto file = folder_.write("file", "");
  refused({"simulate", kNominal, "--out", file / "pass"}, {"cannot be made"});

  const Ran program = refused(
      {"simulate", changed(kNominal, "rate_rpm = 60.0", "rate_rpm = 0"), "--out", out_, "--json"},
      {});
  const std::string error = program.json().at("error");
  EXPECT_THAT(error, HasSubstr("attitude.rate_rpm = 0: must lie in [5, 200] rpm"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Simulate, MakesASeparationThatIsReconstructed) {
  const auto summary = simulated(kSeparation);
  EXPECT_EQ(summary["files"].size(), 6U);
  EXPECT_EQ(summary["gyro_samples"], rows_in(out_ / "gyro.csv").size() - 1);
  EXPECT_EQ(summary["star_fixes"], rows_in(out_ / "star.csv").size() - 1);

  const auto batch = succeeded({"reconstruct", "--mission", out_ / "mission.toml", "--telemetry",
                                out_, "--db", folder_.path() / "out.db", "--json"})
                         .json()["batch"];
  EXPECT_TRUE(batch["launcher"]["inside"]);
  const auto truth = truth_of(out_);
  for (const auto& event : batch["events"]) {
    const auto q = truth[event["event"].get<std::string>()]["q_icrf_body_xyzw"];
    const double off_rad =
        angle_between_rad(Eigen::Quaterniond{event["qw"], event["qx"], event["qy"], event["qz"]},
                          Eigen::Quaterniond{q[3], q[0], q[1], q[2]});
    EXPECT_LT(degrees(off_rad), 3.0 * event["sigma_deg"].get<double>()) << event["event"];
  }
}

TEST_F(Simulate, MakesATumblingSatelliteWhoseAttitudeIsFound) {
  const auto summary = simulated(kTumbling);
  EXPECT_EQ(summary["files"].size(), 7U);
  EXPECT_EQ(summary["gyro_samples"], rows_in(out_ / "gyro.csv").size() - 1);
  // There are attitudes at least from the first star fix on.
  expect_true_attitudes(out_, 50);
}

TEST_F(Simulate, MakesAnOrientationToTheUpperStage) {
  simulated(kUpperStage);
  const auto truth = truth_of(out_);
  EXPECT_LT(truth["settled_s"], 240.0);
  EXPECT_LT(truth["last_off_deg"], 1.0);
  expect_true_attitudes(out_, 70);
}

TEST_F(Simulate, RunsManyOfAScenarioEachAsProcessMakesOfIt) {
  const auto answer = succeeded({"simulate",
                                 changed(kNominal, "[attitude]",
                                         "[[dispersions]]\nkey = \"attitude.dec_deg\"\nsigma = 1\n"
                                         "[attitude]"),
                                 "--runs", "3", "--jobs", "2", "--out", out_, "--json"})
                          .json();
  ASSERT_EQ(answer["runs"].size(), 3U);
  EXPECT_EQ(answer["runs"][2]["seed"], 3);
  EXPECT_EQ(answer["statistics"]["batch_error_deg"]["runs"], 3);
  EXPECT_EQ(rows_in(out_ / "runs.csv").size(), 4U);
  EXPECT_THAT(text_of(out_ / "histograms.svg"), HasSubstr("batch_error_deg"));

  const auto batch = Processed{out_ / "0002"}.run["batch"];
  const auto truth = truth_of(out_ / "0002");
  EXPECT_NE(truth["dec_deg"], -55.0);
  EXPECT_NEAR(answer["runs"][2]["batch_error_deg"], error_deg(batch, truth), 1e-9);
}

TEST_F(Simulate, PlotsHowTheBodyTurnedAndTheLoopsOfItsControl) {
  const Ran program = succeeded({"simulate", kUpperStage, "--out", out_, "--plots", "--json"});
  EXPECT_EQ(program.json()["files"].size(), 7U);
  EXPECT_THAT(text_of(out_ / "flight.svg"), HasSubstr("Momenta of the wheels"));
  EXPECT_THAT(text_of(out_ / "loops.svg"),
              HasSubstr("designed: phase margin 63.6 deg, gain margin infinite"));

  refused({"simulate", kNominal, "--out", folder_.path() / "no", "--plots"},
          {"--plots: SPINNER is a spinner"});
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "no"));
}

TEST_F(Simulate, PublishesTheSamplesOfAThreeAxisSatellite) {
  for (const std::string& scenario : {kSeparation, kTumbling, kUpperStage}) {
    SCOPED_TRACE(scenario);
    std::filesystem::remove(db_);
    std::filesystem::remove_all(out_);
    const auto summary = simulated(scenario);
    served(scenario);
    for (const auto& [table, counted] :
         {std::pair{"gyro_sample", "gyro_samples"}, std::pair{"sun_sample", "sun_vectors"},
          std::pair{"star_sample", "star_fixes"},
          std::pair{"magnetometer_sample", "magnetometer_samples"}}) {
      EXPECT_EQ(count_rows(db_, table), summary.value(counted, std::int64_t{0})) << table;
    }
  }
}

TEST_F(Simulate, PublishesWhatItWouldWrite) {
  simulated(kDirty);
  const nlohmann::json said = served(kDirty);

  auto expected = rows_in(out_ / "pulses.csv");
  expected.erase(expected.begin());
  EXPECT_EQ(said["published"], expected.size());
  auto stored = rows_of(db_, "SELECT t_tai_ns || ',' || channel FROM pulse");
  for (std::string& row : stored) {
    row.pop_back();
  }
  EXPECT_THAT(stored, ::testing::UnorderedElementsAreArray(expected));
}

}  // namespace spindrift::simulate_test
