// Passes in which no single revolution separates the true axis from the false one.

#include <SQLiteCpp/Database.h>

#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/matchers.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"

namespace spindrift::dual_solutions_test {

TEST(DualSolutions, AreSettledByTheirDispersionAsTheGeometryTurns) {
  // One beam is so noisy that the dispersion of its fixes decides before its edges do.
  const Simulated simulated{"gto-nominal.toml",
                            {{"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 20.0"},
                             {"duration_s = 600.0", "duration_s = 1500.0"},
                             {"ir_pulse_s = 5.0e-4", "ir_pulse_s = 2.0e-3"},
                             {"\ndec_deg = -55.0", "\ndec_deg = -20.0"}}};
  const Processed outcome{simulated.without({"sun2", "south"}).pass};
  const auto count = [&](const std::string& condition) {
    return count_rows(outcome.db, "spin_fix WHERE " + condition);
  };
  EXPECT_GE(count("resolution = 'DISPERSION' AND accepted"), 20);
  EXPECT_EQ(count("geometry_case <> 5"), 0);
  EXPECT_EQ(count("accepted AND alternate_ra_deg IS NULL"), 0) << "both candidates are kept";
  for (const char* const estimator : {"mean", "sequential"}) {
    const auto& estimate = outcome.run[estimator];
    ASSERT_FALSE(estimate.is_null()) << outcome.log;
    EXPECT_EQ(estimate["quality"], "OK") << estimator;
    EXPECT_LT(error_deg(estimate, {{"ra_deg", 100.0}, {"dec_deg", -20.0}}),
              3.0 * estimate["sigma_deg"].get<double>())
        << estimator;
  }
}

/// A pass with one beam and sun1. Another axis, 25 deg from the true one, explains the edges as
/// well, and no fix has the true one because its candidates are near tangent.
struct FalseTwin {
  Simulated simulated;
  Processed outcome{simulated.without({"sun2", "north"}).pass};

  FalseTwin(int seed, const std::string& prior)
      : simulated{"gto-nominal.toml",
                  {{"mean_anomaly_deg = 30.0", "mean_anomaly_deg = 60.1"},
                   {"duration_s = 600.0", "duration_s = 300.0\nseed = " + std::to_string(seed)},
                   {"\nra_deg = 100.0\ndec_deg = -55.0", "\nra_deg = 240.11\ndec_deg = 72.64"},
                   {"rate_rpm = 60.0", "rate_rpm = 200.0"},
                   {"[spin.noise]", prior + "[spin.noise]"}}} {}
  std::string quality(const std::string& estimator) const {
    return outcome.run[estimator]["quality"];
  }
};

TEST(DualSolutions, AFalseTwinOfTheTrueAxisLeavesBatchAmbiguous) {
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const FalseTwin twin{seed, ""};
    EXPECT_EQ(twin.quality("sequential"), "AMBIGUOUS");
    EXPECT_EQ(twin.quality("batch"), "AMBIGUOUS");
  }
}

TEST(DualSolutions, APriorSettlesForBatchWhatItsEdgesLeaveOpen) {
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const FalseTwin twin{seed, "[spin.prior]\nra_deg = 240.11\ndec_deg = 72.64\nsigma_deg = 1.0\n"};
    const auto& batch = twin.outcome.run["batch"];
    EXPECT_EQ(batch["quality"], "OK");
    EXPECT_LT(error_deg(batch, {{"ra_deg", 240.11}, {"dec_deg", 72.64}}),
              3.0 * batch["sigma_deg"].get<double>());
  }
}

TEST(DualSolutions, APriorThatAnOperatorToldSettlesABatchSolutionOfTheStoredRun) {
  const FalseTwin twin{1, ""};
  ASSERT_EQ(twin.quality("batch"), "AMBIGUOUS");
  SQLite::Database{twin.outcome.db.string(), SQLite::OPEN_READWRITE, kBusy_ms}.exec(
      "INSERT INTO operator_action SELECT 'a', spacecraft_id, run_id, first_arrival, first_tai_ns, "
      "started_utc, 'shift', 'set_prior', "
      "'{\"ra_deg\":240.11,\"dec_deg\":72.64,\"sigma_deg\":1.0}', '' FROM run");
  const Ran batch = succeeded(
      {"batch", "--mission", twin.simulated.mission(), "--db", twin.outcome.db, "--json"});
  EXPECT_EQ(batch.json()["quality"], "OK") << batch.out;
}

TEST(DualSolutions, APriorFarFromAllOfThemSettlesNothing) {
  const FalseTwin twin{1, "[spin.prior]\nra_deg = 100.0\ndec_deg = -55.0\nsigma_deg = 1.0\n"};
  EXPECT_EQ(twin.quality("batch"), "AMBIGUOUS");
}

}  // namespace spindrift::dual_solutions_test
