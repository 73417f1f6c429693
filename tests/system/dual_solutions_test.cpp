// Passes in which no single revolution separates the true axis from the false one.

#include <SQLiteCpp/Database.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/archive_rows.h"
#include "tests/support/processed_pass.h"

namespace spindrift::dual_solutions_test {

using ::testing::HasSubstr;

double error_deg(double ra_deg, double dec_deg, double true_ra_deg, double true_dec_deg) {
  const auto place = [](double ra, double dec) {
    return direction_icrf({.ra_rad = ra * kRadPerDeg, .dec_rad = dec * kRadPerDeg});
  };
  return angle_between_rad(place(ra_deg, dec_deg), place(true_ra_deg, true_dec_deg)) / kRadPerDeg;
}

TEST(DualSolutions, AreSettledByTheirDispersionAsTheGeometryTurns) {
  // One beam is so noisy that the dispersion of its fixes decides before its edges do.
  const TemporaryFolder folder;
  const auto outcome = process_simulated(folder,
                                         {{"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 20.0"},
                                          {"duration_s = 600.0", "duration_s = 1500.0"},
                                          {"ir_pulse_s = 5.0e-4", "ir_pulse_s = 2.0e-3"},
                                          {"\ndec_deg = -55.0", "\ndec_deg = -20.0"}},
                                         {"sun2", "south"});
  ASSERT_EQ(outcome.status, 0) << outcome.log;
  const auto count = [&](const std::string& condition) {
    return number_of(outcome.db, "SELECT count(*) FROM spin_fix WHERE " + condition);
  };
  EXPECT_GE(count("resolution = 'DISPERSION' AND accepted"), 20);
  EXPECT_EQ(count("geometry_case <> 5"), 0);
  EXPECT_EQ(count("accepted AND alternate_ra_deg IS NULL"), 0) << "both candidates are kept";
  for (const char* const estimator : {"mean", "sequential"}) {
    const auto& estimate = outcome.run[estimator];
    ASSERT_FALSE(estimate.is_null()) << outcome.log;
    EXPECT_EQ(estimate["quality"], "OK") << estimator;
    EXPECT_LT(error_deg(estimate["ra_deg"], estimate["dec_deg"], 100.0, -20.0),
              3.0 * estimate["sigma_deg"].get<double>())
        << estimator;
  }
}

/// Processes a pass with one beam and sun1. Another axis, 25 deg from the true one, explains the
/// edges as well, and no fix has the true one because its candidates are near tangent.
Outcome process_false_twin(const TemporaryFolder& folder, int seed, const std::string& prior) {
  return process_simulated(
      folder,
      {{"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 60.1"},
       {"duration_s = 600.0", "duration_s = 300.0\nseed = " + std::to_string(seed)},
       {"\nra_deg = 100.0\ndec_deg = -55.0", "\nra_deg = 240.11\ndec_deg = 72.64"},
       {"rate_rpm = 60.0", "rate_rpm = 200.0"},
       {"[spin.noise]", prior + "[spin.noise]"}},
      {"sun2", "north"});
}

TEST(DualSolutions, AFalseTwinOfTheTrueAxisLeavesBatchAmbiguous) {
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const TemporaryFolder folder;
    const auto outcome = process_false_twin(folder, seed, "");
    ASSERT_EQ(outcome.status, 0) << outcome.log;
    EXPECT_EQ(outcome.run["sequential"]["quality"], "AMBIGUOUS");
    EXPECT_EQ(outcome.run["batch"]["quality"], "AMBIGUOUS");
  }
}

TEST(DualSolutions, APriorSettlesForBatchWhatItsEdgesLeaveOpen) {
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const TemporaryFolder folder;
    const auto outcome = process_false_twin(
        folder, seed, "[spin.prior]\nra_deg = 240.11\ndec_deg = 72.64\nsigma_deg = 1.0\n");
    ASSERT_EQ(outcome.status, 0) << outcome.log;
    const auto& batch = outcome.run["batch"];
    EXPECT_EQ(batch["quality"], "OK");
    EXPECT_LT(error_deg(batch["ra_deg"], batch["dec_deg"], 240.11, 72.64),
              3.0 * batch["sigma_deg"].get<double>());
  }
}

TEST(DualSolutions, APriorThatAnOperatorToldSettlesABatchSolutionOfTheStoredRun) {
  const TemporaryFolder folder;
  const auto outcome = process_false_twin(folder, 1, "");
  ASSERT_EQ(outcome.run["batch"]["quality"], "AMBIGUOUS") << outcome.log;
  SQLite::Database{outcome.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "INSERT INTO operator_action SELECT 'a', spacecraft_id, run_id, first_arrival, first_tai_ns,"
      " started_utc, 'shift', 'set_prior',"
      " '{\"ra_deg\":240.11,\"dec_deg\":72.64,\"sigma_deg\":1.0}', '' FROM run");
  Program batch{{"batch", "--mission", (folder.path() / "pass" / "mission.toml").string(), "--db",
                 outcome.db.string(), "--json"}};
  ASSERT_EQ(batch.exit_status(), 0) << batch.log();
  EXPECT_EQ(nlohmann::json::parse(batch.out())["quality"], "OK") << batch.out();
}

TEST(DualSolutions, APriorFarFromAllOfThemSettlesNothing) {
  const TemporaryFolder folder;
  const auto outcome = process_false_twin(
      folder, 1, "[spin.prior]\nra_deg = 100.0\ndec_deg = -55.0\nsigma_deg = 1.0\n");
  ASSERT_EQ(outcome.status, 0) << outcome.log;
  EXPECT_EQ(outcome.run["batch"]["quality"], "AMBIGUOUS");
}

}  // namespace spindrift::dual_solutions_test
