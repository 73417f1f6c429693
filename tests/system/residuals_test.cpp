#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/three_axis_files.h"

namespace spindrift::residuals_test {

class Residuals : public ::testing::Test {
 protected:
  void process(const std::string& pass) {
    db_ = folder_.path() / (pass + ".db");
    succeeded(arguments(pass, db_));
  }

  TemporaryFolder folder_;
  std::filesystem::path db_;
};

TEST_F(Residuals, OfTheNominalPassAreNormalAndThoseThatAnIndependentProgramFinds) {
  process("nominal");
  for (const std::string estimator : {"sequential", "batch"}) {
    SCOPED_TRACE(estimator);
    const std::string of_it = " FROM edge_residual WHERE estimator = '" + estimator + "'";
    EXPECT_GT(number_of(db_, "SELECT count(*)" + of_it), 3000);
    // The first turns are left out because `sequential` converges in them.
    EXPECT_NEAR(std::sqrt(real_of(db_, "SELECT avg(whitened * whitened)" + of_it +
                                           " AND used = 1 AND revolution > 20")),
                1.0, 0.05);
    EXPECT_NEAR(real_of(db_, "SELECT avg(whitened)" + of_it + " AND used = 1"), 0.0, 0.1);
  }
  EXPECT_EQ(number_of(db_, "SELECT sum(used) FROM edge_residual WHERE estimator = 'batch'"),
            number_of(db_, "SELECT edges FROM spin_batch"));

  const std::string command =
      "/usr/bin/python3 " + (test_data().parent_path() / "system" / "batch_residuals.py").string() +
      " " + db_.string() + " " + (kPasses / "nominal" / "mission.toml").string();
  const std::unique_ptr<FILE, int (*)(FILE*)> program{::popen(command.c_str(), "r"), &::pclose};
  ASSERT_TRUE(program);
  double largest_s = -1.0;
  ASSERT_EQ(std::fscanf(program.get(), "%lf", &largest_s), 1);
  EXPECT_GT(largest_s, 0.0);
  EXPECT_LT(largest_s, 1e-6);
}

TEST_F(Residuals, AreBeyondTheirLimitWhereLeftOutAndWithinItWhereUsed) {
  for (const std::string pass : {"nominal", "dirty", "coded", "north-only"}) {
    SCOPED_TRACE(pass);
    process(pass);
    EXPECT_THAT(rows_of(db_,
                        "SELECT * FROM edge_residual WHERE whitened IS NOT NULL AND (abs(whitened) "
                        "<= \"limit\") <> used"),
                IsEmpty());
    EXPECT_THAT(rows_of(db_, "SELECT * FROM edge_residual WHERE (rejected_by IS NULL) <> used"),
                IsEmpty());
    const std::string by_the_clock = "pulse_use WHERE rejected_by IN ('phase', 'unassociated')";
    EXPECT_GT(count_rows(db_, by_the_clock), 1);
    EXPECT_EQ(
        count_rows(db_, by_the_clock + " AND residual_ns IS NULL AND (t_tai_ns, channel) NOT IN "
                                       "(SELECT t_tai_ns, channel FROM pulse_gap)"),
        0);
    EXPECT_EQ(count_rows(db_, "pulse_gap WHERE gap_s >= least_gap_s"), 0);
    EXPECT_GT(count_rows(db_, "spin_measurement WHERE expected IS NOT NULL"), 500);
    EXPECT_THAT(
        rows_of(
            db_,
            "SELECT * FROM spin_measurement WHERE expected IS NOT NULL AND (abs(value - expected) "
            "<= \"limit\") <> accepted AND coalesce(rejected_by, quantity) = quantity"),
        IsEmpty());
    EXPECT_THAT(
        rows_of(db_,
                "SELECT * FROM spin_measurement WHERE rejected_by = quantity AND expected IS NULL"),
        IsEmpty());
  }
}

TEST_F(Residuals, AreNotStoredWhereTheMissionFileSaysSo) {
  const PassCopy pass{"nominal"};
  std::ofstream{pass.mission(), std::ios::app} << "\n[archive]\nresiduals = false\n";
  succeeded(pass.arguments_here());
  EXPECT_EQ(count_rows(pass.db, "edge_residual"), 0);
  EXPECT_GT(count_rows(pass.db, "spin_measurement WHERE expected IS NOT NULL"), 0);
}

/// In these passes most fixes determine the axis by themselves.
TEST_F(Residuals, TheChoiceOfARunIsItsAnswerWithWhatSettledItAndHowMuchWorseTheOtherAxisFits) {
  for (const std::string pass : {"nominal", "dirty", "north-only"}) {
    SCOPED_TRACE(pass);
    process(pass);
    EXPECT_EQ(
        count_rows(db_,
                   "spin_fix WHERE NOT EXISTS (SELECT 1 FROM spin_fix_candidate AS c WHERE "
                   "c.revolution = spin_fix.revolution AND c.candidate = 0 AND c.misfit >= 0)"),
        0);
    EXPECT_THAT(rows_of(db_, "SELECT DISTINCT resolution FROM spin_fix WHERE accepted = 1"),
                ElementsAre("GEOMETRY|"))
        << "what the pass chose was settled by that, too";
    EXPECT_THAT(
        rows_of(
            db_,
            "SELECT choice.estimator, settled_by, abs(choice.ra_deg - answer.ra_deg) < 1e-9, "
            "abs(choice.dec_deg - answer.dec_deg) < 1e-9, delta_chi_square > 20, delta_chi_square "
            "<= 64 * (edges + outliers), abs(choice.dec_deg - verdict.dec_deg) < verdict.sigma_deg "
            "FROM axis_choice AS choice JOIN pass_answer AS answer ON answer.run_id = "
            "choice.run_id AND answer.estimator = choice.estimator JOIN pass_verdict AS verdict ON "
            "verdict.run_id = choice.run_id JOIN spin_batch AS batch ON batch.run_id = "
            "choice.run_id AND batch.t_tai_ns = choice.t_tai_ns"),
        ElementsAre("batch|geometry|1|1|1|1|1|"));
  }
}

/// Those of the reconstruction are the same whether the filter processes the samples too or not.
TEST_F(Residuals, OfAThreeAxisPassAreThoseOfItsSensorsAndOfItsReconstructionWithValueAndLimit) {
  testing::write_three_axis_pass(
      folder_.path(),
      {.duration_s = 300.0, .gyro_s = 1.0, .star_s = 5.0, .sun_s = 5.0, .separation = true});
  for (const std::string command : {"process", "reconstruct"}) {
    SCOPED_TRACE(command);
    db_ = folder_.path() / (command + ".db");
    succeeded({command, "--mission", folder_.path() / "mission.toml", "--telemetry", folder_.path(),
               "--db", db_});
    // `batch` uses the fixes up to two minutes after the first one, `sequential` only that one.
    EXPECT_THAT(
        rows_of(db_,
                "SELECT estimator, kind, dof, unit, rejected_by, count(*) FROM sample_residual "
                "WHERE kind IN ('gyro', 'star') AND estimator <> 'mekf' GROUP BY 1, 2, 3, 4, 5 "
                "ORDER BY 1, 2, 5"),
        ElementsAre("batch|gyro|1|deg_s|saturated|1|", "batch|star|3|deg||24|",
                    "batch|star|3|deg|innovation|1|", "sequential|gyro|1|deg_s|saturated|1|",
                    "sequential|star|3|deg||1|", "sequential|star|3|deg|innovation|1|"));
    EXPECT_THAT(rows_of(db_,
                        "SELECT * FROM sample_residual WHERE kind = 'gyro' AND (residual_1 <= "
                        "\"limit\" OR nis IS NOT NULL OR sigma_1 IS NOT NULL)"),
                IsEmpty());
  }

  db_ = folder_.path() / "process.db";
  EXPECT_THAT(rows_of(db_, "SELECT DISTINCT estimator FROM sample_residual ORDER BY 1"),
              ElementsAre("batch|", "mekf|", "sequential|"));
  EXPECT_THAT(
      rows_of(db_,
              "SELECT * FROM sample_residual WHERE nis IS NOT NULL AND (nis <= \"limit\") <> used"),
      IsEmpty());
  EXPECT_THAT(rows_of(db_,
                      "SELECT DISTINCT kind, dof, unit FROM sample_residual WHERE estimator = "
                      "'mekf' AND kind <> 'gyro' ORDER BY 1"),
              ElementsAre("magnetometer|3|nT|", "star|3|deg|", "sun|2|deg|"));
  EXPECT_THAT(
      rows_of(db_,
              "SELECT * FROM rejected_sample WHERE rejected_by IN ('innovation', 'saturated', "
              "'frozen', 'outlier') AND (value IS NULL OR value <= \"limit\")"),
      IsEmpty());
}

}  // namespace spindrift::residuals_test
