// The estimator `batch` as an analyst uses it: at the end of `process`, as a command, and in the
// archive.

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/exact_mission.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/simulated.h"

namespace spindrift::batch_test {

nlohmann::json truth_of(const std::string& pass) {
  return nlohmann::json::parse(text_of(kPasses / pass / "truth.json"));
}

nlohmann::json answer(const Words& words) { return succeeded(words).json(); }

/// Returns the arguments of `batch` for a recorded pass in an archive.
Words batch_of(const std::string& pass, const std::filesystem::path& db, const Words& more) {
  return with({"batch", "--mission", kPasses / pass / "mission.toml", "--db", db}, more);
}

TEST(Batch, StandsBesideTheOtherEstimatorsWithBoundAndBiases) {
  const Processed processed{"nominal"};
  const auto& db = processed.db;
  const auto& batch = processed.run["batch"];
  EXPECT_EQ(batch["quality"], "OK");
  const double sigma_deg = batch["sigma_deg"].get<double>();
  EXPECT_LT(error_deg(batch, truth_of("nominal")), std::min(0.05, 3.0 * sigma_deg));
  const double noise_sigma_deg = batch["noise_sigma_deg"].get<double>();
  EXPECT_NEAR(noise_sigma_deg / batch["bound_deg"].get<double>(), 1.0, 0.01);
  EXPECT_LT(noise_sigma_deg, sigma_deg);
  const double consider_deg = batch["consider_sigma_deg"].get<double>();
  EXPECT_EQ(consider_deg, sigma_deg);
  EXPECT_EQ(consider_deg, real_of(db, "SELECT consider_sigma_deg FROM spin_batch"));
  const double drift_sigma_rpm_h = batch["rate_drift_sigma_rpm_h"].get<double>();
  EXPECT_NEAR(batch["rate_drift_rpm_h"].get<double>(), 0.0, 3.0 * drift_sigma_rpm_h);
  EXPECT_EQ(batch["rate_drift_rpm_h"], real_of(db, "SELECT rate_drift_rpm_h FROM spin_batch"));
  EXPECT_EQ(drift_sigma_rpm_h, real_of(db, "SELECT rate_drift_sigma_rpm_h FROM spin_batch"));
  EXPECT_FALSE(batch["nutation"]["detected"]);
  EXPECT_EQ(batch["biases"].size(), 8U);

  EXPECT_EQ(count_rows(db, "spin_batch WHERE outliers < 5 AND noise = 1"), 1);
  EXPECT_EQ(count_rows(db, "spin_bias WHERE estimator = 'batch'"), 8);
  // A bias that the edges do not determine has no value, only its prior.
  EXPECT_GT(count_rows(db, "spin_bias WHERE observable = 0 AND value IS NULL"), 0);
  EXPECT_EQ(count_rows(db, "spin_comparison WHERE NOT disagree"), 3);
  EXPECT_LT(real_of(db, "SELECT max(apart_deg) FROM spin_comparison"), 0.01);
}

TEST(Batch, EstimatorsThatAModelErrorSetsApartAreNamedAsTheViewFlagsThem) {
  const PassCopy pass{"nominal"};
  // `batch` estimates this bias; for the other estimators it is an error.
  pass.replace("mount_angle_deg = 85", "mount_angle_deg = 86");
  pass.append(kExactSpin);
  const auto told = answer(pass.arguments_here())["runs"][0]["disagreements"];
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0]["one"], "sequential");
  EXPECT_EQ(told[0]["other"], "batch");
  EXPECT_THAT(
      rows_of(pass.db, "SELECT apart_deg, apart_sigmas FROM spin_comparison WHERE disagree"),
      ElementsAre(fmt::format("{:a}|{:a}|", told[0]["apart_deg"].get<double>(),
                              told[0]["apart_sigmas"].get<double>())));
  EXPECT_GT(told[0]["apart_sigmas"].get<double>(), 3.0);

  const TemporaryFolder folder;
  const Ran text = succeeded({"process", "--mission", pass.mission(), "--telemetry",
                              pass.folder.path(), "--db", folder.path() / "out.db"});
  EXPECT_THAT(text.out, HasSubstr("comparison   sequential and batch disagree: their axes are 0."));
  EXPECT_THAT(text.log, HasSubstr("SPINNER: sequential and batch disagree: their axes are 0."));
}

TEST(Batch, AGapOfTheOrbitCostsTheEdgesThereOnly) {
  const PassCopy pass{"nominal"};
  const auto orbit = pass.folder.path() / "orbit.oem";
  std::string text = text_of(orbit);
  const std::string head = text.substr(
      text.find("META_START"), text.find("2026-11-20T02:58:00.000 ") - text.find("META_START"));
  // The orbit consists of two segments with a gap of a minute.
  std::string second = head;
  second.replace(second.find("02:58:00"), 8, "03:05:00");
  const auto gap = text.find("2026-11-20T03:04:30.000 ");
  text.replace(gap, text.find("2026-11-20T03:05:00.000 ") - gap, second);
  text.replace(text.find("03:12:00"), 8, "03:04:00");
  std::ofstream{orbit} << text;
  const auto run = answer(pass.arguments_here())["runs"][0];
  EXPECT_GT(run["edges_rejected"]["no_orbit"].get<int>(), 300);
  const auto batch = run["batch"];
  ASSERT_FALSE(batch.is_null());
  EXPECT_EQ(batch["quality"], "OK");
  EXPECT_LT(error_deg(batch, truth_of("nominal")), 3.0 * batch["sigma_deg"].get<double>());
}

TEST(Batch, SaysWhenTheMissionIsNotThatOfTheRun) {
  const PassCopy pass{"nominal"};
  succeeded(pass.arguments_here());
  const Words again{"batch", "--mission", pass.mission(), "--db", pass.db, "--json"};
  EXPECT_EQ(answer(again)["same_mission"], true);

  pass.replace("mount_angle_deg = 85", "mount_angle_deg = 86");
  const Ran other = succeeded(again);
  EXPECT_EQ(other.json()["same_mission"], false);
  EXPECT_THAT(other.log, HasSubstr("SPINNER: the mission file is not that of run "));
  EXPECT_THAT(other.log, Not(HasSubstr("orbit file is not")));
}

TEST(Batch, SolvesAStoredRunAgainAndOnlyItsLastRevolutions) {
  const Processed processed{"gms5"};
  const auto& db = processed.db;
  const auto& in_process = processed.run;
  const auto solved = answer(batch_of("gms5", db, {"--json"}));
  EXPECT_EQ(solved["run_id"], in_process["run_id"]);
  EXPECT_EQ(solved["edges"], in_process["batch"]["edges"]);
  EXPECT_NEAR(solved["ra_deg"].get<double>(), in_process["batch"]["ra_deg"].get<double>(), 1e-6);
  EXPECT_LT(error_deg(solved, truth_of("gms5")), 0.02);

  const auto hundred = answer(batch_of("gms5", db, {"--last", "100", "--json"}));
  EXPECT_LE(hundred["edges"].get<int>(), 600);
  EXPECT_GT(hundred["bound_deg"].get<double>(), 2.0 * solved["bound_deg"].get<double>());

  EXPECT_THAT(succeeded(batch_of("gms5", db, {})).out,
              HasSubstr("bound        0.0016 deg (Cramer-Rao)"));
}

TEST(Batch, ASpacecraftOrRunThatTheArchiveHasNotIsNamed) {
  const Processed processed{"nominal"};
  const auto& db = processed.db;
  refused(batch_of("gms5", db, {}), {"has no run of spacecraft 'GMS-5' with revolutions"});
  refused(batch_of("nominal", db, {"--run", "nope"}), {"has no run nope of spacecraft 'SPINNER'"});
}

TEST(Batch, LastTakesAPositiveIntegerOnly) {
  for (const std::string last : {"0", "-3", "abc", "1.5", "99999999999999999999"}) {
    refused(batch_of("nominal", "any.db", {"--last=" + last}),
            {"spindrift: --last: '" + last + "': must be a positive integer\n"});
  }
}

TEST(Batch, AnArchiveThatIsNotThereIsBadInputAndIsNotMade) {
  const TemporaryFolder folder;
  folder.write("empty.db", "");
  const auto expect_refused = [&](const std::filesystem::path& db, const std::string& says) {
    const Ran program = refused(batch_of("nominal", db, {"--json"}), {says});
    EXPECT_EQ(program.json()["error"], says);
  };
  const auto expect_no_archive = [&](const std::filesystem::path& db, const std::string& why) {
    expect_refused(db, "there is no archive " + db.string() + ": " + why);
  };
  expect_no_archive(folder.path() / "absent.db", "no such file");
  expect_no_archive(folder.path() / "nowhere" / "absent.db", "no such file");
  expect_no_archive(folder.path() / "empty.db" / "absent.db", "no such file");
  expect_no_archive(folder.path() / "empty.db", "the file is empty");
  expect_refused(folder.path(),
                 "archive \"" + folder.path().string() + "\": is a directory, must be a file");
  const std::filesystem::directory_iterator left{folder.path()};
  EXPECT_EQ(std::distance(begin(left), end(left)), 1);
}

TEST(Batch, EstimatesTheBiasesThatTheMissionAsksFor) {
  const PassCopy pass{"nominal"};
  const Processed processed{"nominal"};
  std::ofstream{pass.mission(), std::ios::app}
      << "\n[spin.batch]\ndihedral = true\nsun_angle = false\n";
  const auto solved =
      answer({"batch", "--mission", pass.mission(), "--db", processed.db, "--json"});
  EXPECT_THAT(solved["status"].get<std::string>(), HasSubstr("dihedral"));
  const auto& dihedral = solved["biases"]["dihedral"];
  EXPECT_TRUE(dihedral["observable"]);
  EXPECT_LT(std::abs(dihedral["value"].get<double>()), 3.0 * dihedral["sigma"].get<double>());
}

/// Holds a processed run of a delivered scenario with an addition to its attitude.
struct WobblingRun {
  Simulated simulated;
  Processed processed;
  const std::filesystem::path& db = processed.db;
  nlohmann::json batch = processed.run["batch"];
  nlohmann::json truth = nlohmann::json::parse(text_of(simulated.pass / "truth.json"));

  explicit WobblingRun(const std::string& attitude, const std::string& told = {})
      : simulated{"gto-nominal.toml", {{"[spin.sun_sensor]", attitude + "[spin.sun_sensor]"}}},
        processed{told_in(simulated, told)} {}
  /// Adds to the mission file.
  static std::filesystem::path told_in(const Simulated& simulated, const std::string& told) {
    std::ofstream{simulated.mission(), std::ios::app} << told;
    return simulated.pass;
  }
  double nutation(const std::string& column) const {
    return real_of(db, "SELECT " + column + " FROM spin_nutation");
  }
  void expect_true_axis() const {
    EXPECT_EQ(batch["quality"], "OK");
    EXPECT_EQ(batch["noise"], 1.0);
    EXPECT_LT(error_deg(batch, truth), 3.0 * batch["sigma_deg"].get<double>());
  }
};

TEST(Batch, NutationThatGrowsIsFoundTakenOutAndStored) {
  const WobblingRun run{
      "[attitude.nutation]\nhalf_angle_deg = 0.1\ninertia_ratio = 0.37\n"
      "phase_deg = 50.0\ngrowth_per_h = 6.0\n"};
  run.expect_true_axis();
  const auto& truth = run.truth["nutation"];
  EXPECT_EQ(number_of(run.db, "SELECT detected FROM spin_nutation"), 1);
  EXPECT_NEAR(run.nutation("growth_per_h"), truth["growth_per_h"].get<double>(),
              3.0 * run.nutation("growth_sigma_per_h"));
  EXPECT_LT(run.nutation("growth_sigma_per_h"), 1.0);
  EXPECT_NEAR(run.nutation("period_s"), truth["period_s"].get<double>(), 0.001);
  const double into_pass_h = real_of(
      run.db,
      "SELECT (at_tai_ns - first_tai_ns) / 3.6e12 FROM spin_nutation JOIN run USING (run_id)");
  EXPECT_NEAR(run.nutation("half_angle_deg"), 0.1 * std::exp(6.0 * into_pass_h),
              3.0 * run.nutation("half_angle_sigma_deg"));
  EXPECT_TRUE(run.batch["nutation"]["detected"]);
}

TEST(Batch, ConingThatNobodyAskedForIsDoubted) {
  const WobblingRun run{"[attitude.coning]\ntilt_deg = 0.3\nazimuth_deg = 40.0\n"};
  EXPECT_EQ(run.batch["quality"], "DOUBTFUL");
  EXPECT_THAT(run.batch["status"].get<std::string>(), HasSubstr("or a misplaced sensor"));
  EXPECT_EQ(number_of(run.db, "SELECT detected FROM spin_coning"), 1);
}

TEST(Batch, ConingIsFoundTakenOutAndStored) {
  const WobblingRun run{"[attitude.coning]\ntilt_deg = 0.3\nazimuth_deg = 40.0\n",
                        "[spin.batch]\nconing = true\n"};
  run.expect_true_axis();
  EXPECT_THAT(run.batch["status"].get<std::string>(), HasSubstr(", coning 0."));
  EXPECT_EQ(number_of(run.db, "SELECT detected FROM spin_coning"), 1);
  const auto column = [&](const std::string& name) {
    return real_of(run.db, "SELECT " + name + " FROM spin_coning");
  };
  EXPECT_NEAR(column("tilt_deg"), 0.3, 3.0 * column("tilt_sigma_deg"));
  EXPECT_NEAR(column("azimuth_deg"), 40.0, 3.0 * column("azimuth_sigma_deg"));
  EXPECT_EQ(count_rows(run.db, "spin_bias"), 8);
}

}  // namespace spindrift::batch_test
