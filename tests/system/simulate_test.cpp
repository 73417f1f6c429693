#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift::simulate_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::filesystem::path kScenarios = scenarios();
const std::string kNominal = (kScenarios / "gto-nominal.toml").string();
const std::string kDirty = (kScenarios / "gto-dirty.toml").string();
const std::string kSeparation = (kScenarios / "separation.toml").string();
const std::string kTumbling = (kScenarios / "tumbling.toml").string();
const std::string kUpperStage = (kScenarios / "upper-stage.toml").string();
const std::string kLastMean =
    " FROM spin_estimate WHERE estimator = 'mean' ORDER BY t_tai_ns DESC LIMIT 1";

nlohmann::json simulated(const std::string& scenario, const std::filesystem::path& out) {
  Program program{{"simulate", scenario, "--out", out.string(), "--json"}};
  EXPECT_EQ(program.exit_status(), 0) << program.log();
  // Standard error is a file here, so no progress bar is drawn.
  EXPECT_EQ(program.log(), "");
  return nlohmann::json::parse(program.out());
}

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  std::istringstream text{text_of(path)};
  for (std::string line; std::getline(text, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Returns a delivered scenario with a replacement.
std::string changed(const TemporaryFolder& folder, const std::string& scenario,
                    const std::string& from, const std::string& to) {
  std::string text = text_of(scenario);
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return folder.write("scenario.toml", text.replace(at, from.size(), to)).string();
}

TEST(Simulate, MakesAPassOfWhichTheAxisIsFound) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "deep" / "pass";
  const auto summary = simulated(kNominal, out);
  EXPECT_EQ(summary["revolutions"], 600);
  EXPECT_EQ(summary["edges"], 3600);
  EXPECT_EQ(summary["spacecraft"], "SPINNER");
  EXPECT_EQ(summary["files"].size(), 4U);
  for (const auto& file : summary["files"]) {
    EXPECT_TRUE(std::filesystem::exists(file.get<std::string>())) << file;
  }

  const auto db = folder.path() / "pass.db";
  Program process{{"process", "--mission", (out / "mission.toml").string(), "--telemetry",
                   out.string(), "--db", db.string(), "--strict"}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();
  const auto truth = nlohmann::json::parse(text_of(out / "truth.json"));
  const auto place = [](double ra_deg, double dec_deg) {
    return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
  };
  const double error_deg = angle_between_rad(place(truth["ra_deg"], truth["dec_deg"]),
                                             place(real_of(db, "SELECT ra_deg" + kLastMean),
                                                   real_of(db, "SELECT dec_deg" + kLastMean))) *
                           180.0 / std::numbers::pi;
  // Three sigma of a two-dimensional error, where sigma covers both directions.
  EXPECT_LT(error_deg, 3.0 * real_of(db, "SELECT sigma_deg" + kLastMean));
  EXPECT_NEAR(real_of(db, "SELECT spin_rate_rpm" + kLastMean), truth["rpm"],
              4.0 * real_of(db, "SELECT sigma_rpm" + kLastMean));
}

TEST(Simulate, TellsTheTruthAboutEveryFault) {
  const TemporaryFolder folder;
  const auto summary = simulated(kDirty, folder.path() / "pass");
  const auto truth = nlohmann::json::parse(text_of(folder.path() / "pass" / "truth.json"));
  const auto rows = lines_of(folder.path() / "pass" / "pulses.csv");

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

TEST(Simulate, GivesTheSameBytesForTheSameSeed) {
  const TemporaryFolder folder;
  simulated(kDirty, folder.path() / "a");
  simulated(kDirty, folder.path() / "b");
  simulated(changed(folder, kDirty, "seed = 7", "seed = 8"), folder.path() / "c");
  for (const char* const name : {"pulses.csv", "orbit.oem", "mission.toml", "truth.json"}) {
    EXPECT_EQ(text_of(folder.path() / "a" / name), text_of(folder.path() / "b" / name)) << name;
  }
  EXPECT_NE(text_of(folder.path() / "a" / "pulses.csv"),
            text_of(folder.path() / "c" / "pulses.csv"));
}

TEST(Simulate, WritesCodedTelemetryOneRowARevolution) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  simulated(changed(folder, kNominal, "[attitude]",
                    "[telemetry]\nkind = \"both\"\ncoded_resolution_s = 1e-4\n[attitude]"),
            out);
  const auto rows = lines_of(out / "coded.csv");
  ASSERT_EQ(rows.size(), 601U);
  EXPECT_EQ(rows[0], "t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s");
  std::vector<std::string> sun1;
  for (const std::string& row : lines_of(out / "pulses.csv")) {
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

TEST(Simulate, ReplacesItsOwnFilesButRefusesAFolderWithOtherTelemetry) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  simulated(kDirty, out);
  simulated(kNominal, out);
  EXPECT_EQ(lines_of(out / "pulses.csv").size(), 3601U);

  std::ofstream{out / "other.csv"} << "t_tai_ns,channel\n";
  Program refused{{"simulate", kDirty, "--out", out.string()}};
  EXPECT_EQ(refused.exit_status(), 2);
  EXPECT_THAT(refused.log(), HasSubstr("other.csv: is not of this pass"));
  EXPECT_EQ(lines_of(out / "pulses.csv").size(), 3601U);
}

TEST(Simulate, LeavesNothingHalfWrittenOnAFullDisk) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  Program program{{"simulate", kNominal, "--out", out.string()}, 32};
  EXPECT_EQ(program.exit_status(), 1);
  EXPECT_THAT(program.log(), HasSubstr("pulses.csv: cannot be written: File too large"));
  EXPECT_TRUE(std::filesystem::is_empty(out));
}

TEST(Simulate, RefusesWhereTheFolderCannotBe) {
  const TemporaryFolder folder;
  const auto file = folder.write("file", "");
  Program program{{"simulate", kNominal, "--out", (file / "pass").string()}};
  EXPECT_EQ(program.exit_status(), 2);
  EXPECT_THAT(program.log(), HasSubstr("cannot be made"));
}

TEST(Simulate, RefusesABadScenarioBeforeItWritesAnything) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  Program program{{"simulate", changed(folder, kNominal, "rate_rpm = 60.0", "rate_rpm = 0"),
                   "--out", out.string(), "--json"}};
  EXPECT_EQ(program.exit_status(), 2);
  const std::string error = nlohmann::json::parse(program.out()).at("error");
  EXPECT_THAT(error, HasSubstr("attitude.rate_rpm = 0: must lie in [5, 200] rpm"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Simulate, RefusesABadCommandLine) {
  for (const std::vector<std::string>& bad : std::vector<std::vector<std::string>>{
           {"simulate"},
           {"simulate", kNominal},
           {"simulate", kNominal, "--out", "x", "--runs", "0"},
           {"simulate", kNominal, "--out", "x", "--jobs", "2"},
           {"simulate", kNominal, "--out", "x", "--publish", "--runs", "2"},
           {"simulate", kNominal, "--out", "x", "--runs", "2", "--plots"},
           {"simulate", kNominal, "--out", "x", "--speed", "2"},
           {"simulate", kNominal, "--out", "x", "--partition", "replay"},
           {"simulate", kNominal, "--publish", "--speed", "-1"},
           {"simulate", kNominal, "--publish", "--partition", "*"}}) {
    Program program{bad};
    EXPECT_EQ(program.exit_status(), 2);
    EXPECT_THAT(program.log(), HasSubstr("--help"));
  }
}

TEST(Simulate, MakesASeparationThatIsReconstructed) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  const auto summary = simulated(kSeparation, out);
  EXPECT_EQ(summary["files"].size(), 6U);
  EXPECT_EQ(summary["gyro_samples"], lines_of(out / "gyro.csv").size() - 1);
  EXPECT_EQ(summary["star_fixes"], lines_of(out / "star.csv").size() - 1);

  Program reconstruct{{"reconstruct", "--mission", (out / "mission.toml").string(), "--telemetry",
                       out.string(), "--db", (folder.path() / "out.db").string(), "--json"}};
  ASSERT_EQ(reconstruct.exit_status(), 0) << reconstruct.log();
  const auto batch = nlohmann::json::parse(reconstruct.out())["batch"];
  EXPECT_TRUE(batch["launcher"]["inside"]);
  const auto truth = nlohmann::json::parse(text_of(out / "truth.json"));
  for (const auto& event : batch["events"]) {
    const auto q = truth[event["event"].get<std::string>()]["q_icrf_body_xyzw"];
    const double off_rad =
        angle_between_rad(Eigen::Quaterniond{event["qw"], event["qx"], event["qy"], event["qz"]},
                          Eigen::Quaterniond{q[3], q[0], q[1], q[2]});
    EXPECT_LT(degrees(off_rad), 3.0 * event["sigma_deg"].get<double>()) << event["event"];
  }
}

/// Counts the attitudes of `process` at the times of the true history, and those off by more than
/// four sigma.
struct Judged {
  int count = 0;
  int wrong = 0;
};

Judged judged_attitudes(const TemporaryFolder& folder, const std::filesystem::path& out) {
  const auto db = folder.path() / "pass.db";
  Program process{{"process", "--mission", (out / "mission.toml").string(), "--telemetry",
                   out.string(), "--db", db.string(), "--strict"}};
  EXPECT_EQ(process.exit_status(), 0) << process.log();
  Judged judged;
  const auto told = nlohmann::json::parse(text_of(out / "truth.json"));
  for (const auto& truth : told["history"]) {
    const auto row = [&](const char* column) {
      return real_of(db, fmt::format("SELECT {} FROM attitude WHERE t_tai_ns = {}", column,
                                     truth[0].get<std::int64_t>()));
    };
    if (number_of(db, fmt::format("SELECT count(*) FROM attitude WHERE t_tai_ns = {}",
                                  truth[0].get<std::int64_t>())) == 1) {
      const double off_rad =
          angle_between_rad(Eigen::Quaterniond{row("qw"), row("qx"), row("qy"), row("qz")},
                            Eigen::Quaterniond{truth[4], truth[1], truth[2], truth[3]});
      ++judged.count;
      judged.wrong += degrees(off_rad) > 4.0 * row("sigma_deg") ? 1 : 0;
    }
  }
  return judged;
}

TEST(Simulate, MakesATumblingSatelliteWhoseAttitudeIsFound) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  const auto summary = simulated(kTumbling, out);
  EXPECT_EQ(summary["files"].size(), 7U);
  EXPECT_EQ(summary["gyro_samples"], lines_of(out / "gyro.csv").size() - 1);
  const Judged judged = judged_attitudes(folder, out);
  // There are attitudes at least from the first star fix on.
  EXPECT_GT(judged.count, 50);
  EXPECT_EQ(judged.wrong, 0);
}

TEST(Simulate, MakesAnOrientationToTheUpperStage) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  simulated(kUpperStage, out);
  const auto truth = nlohmann::json::parse(text_of(out / "truth.json"));
  EXPECT_LT(truth["settled_s"], 240.0);
  EXPECT_LT(truth["last_off_deg"], 1.0);
  const Judged judged = judged_attitudes(folder, out);
  EXPECT_GT(judged.count, 70);
  EXPECT_EQ(judged.wrong, 0);
}

TEST(Simulate, RunsManyOfAScenarioEachAsProcessMakesOfIt) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "runs";
  Program program{{"simulate",
                   changed(folder, kNominal, "[attitude]",
                           "[[dispersions]]\nkey = \"attitude.dec_deg\"\nsigma = 1\n"
                           "[attitude]"),
                   "--runs", "3", "--jobs", "2", "--out", out.string(), "--json"}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  const auto answer = nlohmann::json::parse(program.out());
  ASSERT_EQ(answer["runs"].size(), 3U);
  EXPECT_EQ(answer["runs"][2]["seed"], 3);
  EXPECT_EQ(answer["statistics"]["batch_error_deg"]["runs"], 3);
  EXPECT_EQ(lines_of(out / "runs.csv").size(), 4U);
  EXPECT_THAT(text_of(out / "histograms.svg"), HasSubstr("batch_error_deg"));

  const auto pass = out / "0002";
  const auto db = folder.path() / "pass.db";
  Program process{{"process", "--mission", (pass / "mission.toml").string(), "--telemetry",
                   pass.string(), "--db", db.string(), "--json"}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();
  const auto batch = nlohmann::json::parse(process.out())["runs"][0]["batch"];
  const auto truth = nlohmann::json::parse(text_of(pass / "truth.json"));
  const auto place = [](const nlohmann::json& axis) {
    return direction_icrf({.ra_rad = axis["ra_deg"].get<double>() * kRadPerDeg,
                           .dec_rad = axis["dec_deg"].get<double>() * kRadPerDeg});
  };
  EXPECT_NE(truth["dec_deg"], -55.0);
  EXPECT_NEAR(answer["runs"][2]["batch_error_deg"],
              degrees(angle_between_rad(place(batch), place(truth))), 1e-9);
}

TEST(Simulate, PlotsHowTheBodyTurnedAndTheLoopsOfItsControl) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  Program program{{"simulate", kUpperStage, "--out", out.string(), "--plots", "--json"}};
  ASSERT_EQ(program.exit_status(), 0) << program.log();
  EXPECT_EQ(nlohmann::json::parse(program.out())["files"].size(), 7U);
  EXPECT_THAT(text_of(out / "flight.svg"), HasSubstr("Momenta of the wheels"));
  EXPECT_THAT(text_of(out / "loops.svg"),
              HasSubstr("designed: phase margin 63.6 deg, gain margin infinite"));

  Program spinner{{"simulate", kNominal, "--out", (folder.path() / "no").string(), "--plots"}};
  EXPECT_EQ(spinner.exit_status(), 2);
  EXPECT_THAT(spinner.log(), HasSubstr("--plots: SPINNER is a spinner"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "no"));
}

/// Runs a service that receives `simulate --publish` and is stopped afterwards.
/// @return JSON output of `simulate`.
nlohmann::json served(const std::string& scenario, const std::filesystem::path& out,
                      const std::filesystem::path& db) {
  const auto bus = bus_of_its_own();
  const std::string domain = std::to_string(bus.domain);
  Program service{{"serve", "--mission", (out / "mission.toml").string(), "--db", db.string(),
                   "--domain", domain, "--partition", bus.partition}};
  EXPECT_TRUE(service.says("ready")) << service.log();
  Program publishing{{"simulate", scenario, "--publish", "--speed", "0", "--domain", domain,
                      "--partition", bus.partition, "--json"}};
  EXPECT_EQ(publishing.exit_status(), 0) << publishing.log();
  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_status(), 0) << service.log();
  return nlohmann::json::parse(publishing.out());
}

TEST(Simulate, PublishesTheSamplesOfAThreeAxisSatellite) {
  for (const std::string& scenario : {kSeparation, kTumbling, kUpperStage}) {
    SCOPED_TRACE(scenario);
    const TemporaryFolder folder;
    const auto out = folder.path() / "pass";
    const auto summary = simulated(scenario, out);
    const auto db = folder.path() / "served.db";
    served(scenario, out, db);
    for (const auto& [table, counted] :
         {std::pair{"gyro_sample", "gyro_samples"}, std::pair{"sun_sample", "sun_vectors"},
          std::pair{"star_sample", "star_fixes"},
          std::pair{"magnetometer_sample", "magnetometer_samples"}}) {
      EXPECT_EQ(number_of(db, std::string{"SELECT count(*) FROM "} + table),
                summary.value(counted, std::int64_t{0}))
          << table;
    }
  }
}

TEST(Simulate, PublishesWhatItWouldWrite) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "pass";
  simulated(kDirty, out);
  const auto db = folder.path() / "served.db";
  const nlohmann::json said = served(kDirty, out, db);

  auto expected = lines_of(out / "pulses.csv");
  expected.erase(expected.begin());
  EXPECT_EQ(said["published"], expected.size());
  auto stored = rows_of(db, "SELECT t_tai_ns || ',' || channel FROM pulse");
  for (std::string& row : stored) {
    row.pop_back();
  }
  EXPECT_THAT(stored, ::testing::UnorderedElementsAreArray(expected));
}

}  // namespace spindrift::simulate_test
