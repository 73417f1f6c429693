#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/axis_error.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/service.h"
#include "tests/support/simulated.h"
#include "tests/support/test_paths.h"

namespace spindrift::coded_test {

const std::filesystem::path kPass = recorded_passes() / "coded";

constexpr const char* kCoded = "[telemetry]\nkind = \"coded\"\n";

/// An archive of a service with the mission of a pass and what a command publishes.
struct Served {
  TemporaryFolder folder;
  std::filesystem::path db = folder.path() / "served.db";

  Served(const std::filesystem::path& pass, const Words& source) {
    const bus::BusConfig bus = bus_of_its_own();
    serve_whole(on(bus, {"serve", "--mission", pass / "mission.toml", "--db", db}),
                [&] { succeeded(on(bus, source)); });
  }
};

std::vector<std::string> coded_rows(const std::filesystem::path& db) {
  return rows_of(db,
                 "SELECT spacecraft_id, t_tai_ns, period_s, sun2_s, north_in_s, north_out_s, "
                 "south_in_s, south_out_s FROM coded_frame ORDER BY 1, 2");
}

double off_deg(const Processed& processed, const std::string& estimator,
               const std::filesystem::path& pass) {
  return error_deg(axis_in(processed.db, "FROM pass_answer WHERE estimator = '" + estimator + "'"),
                   nlohmann::json::parse(text_of(pass / "truth.json")));
}

TEST(Coded, GivesTheSameProductsLiveAsOfflineFindsTheAxisAndCountsFramesAndTheirEdges) {
  const Processed offline{kPass, {"--strict"}};
  const Served served{
      kPass, {"replay", "--mission", kPass / "mission.toml", "--telemetry", kPass, "--speed", "0"}};
  const auto rows = product_rows(offline.db);
  EXPECT_GT(rows.size(), 4000U);
  EXPECT_EQ(product_rows(served.db), rows);
  EXPECT_EQ(last_batch_rows(served.db), last_batch_rows(offline.db));
  EXPECT_EQ(coded_rows(offline.db).size(), 299U);
  EXPECT_EQ(coded_rows(served.db), coded_rows(offline.db));
  for (const std::string estimator : {"mean", "sequential"}) {
    EXPECT_LT(off_deg(offline, estimator, kPass), 0.1) << estimator;
  }

  const auto& run = offline.run;
  EXPECT_EQ(run["coded_frames_received"], 299);
  const std::int64_t edges = number_of(
      offline.db,
      "SELECT sum(1 + (sun2_s IS NOT NULL) + (north_in_s IS NOT NULL) + (north_out_s IS NOT NULL) "
      "+ (south_in_s IS NOT NULL) + (south_out_s IS NOT NULL)) FROM coded_frame");
  EXPECT_GT(edges, 5 * 299);
  EXPECT_EQ(run["edges_received"], edges);
  EXPECT_EQ(run["edges_stored"], edges);
  EXPECT_EQ(run["edges_accepted"], number_of(offline.db, "SELECT sum(accepted) FROM pulse_use"));
}

TEST(Coded, SimulatedPassGivesTheSameProductsFromTheBusAsFromFiles) {
  const Simulated simulated{"gto-nominal.toml", {}, kCoded};
  const Processed offline{simulated.pass, {"--strict"}};
  const Served served{simulated.pass, simulated.publish()};
  EXPECT_EQ(coded_rows(offline.db).size(), 600U);
  EXPECT_EQ(product_rows(served.db), product_rows(offline.db));
}

/// The drift changes the period by a hundred times its noise each turn.
TEST(Coded, FramesOfASlowBodyThatDriftsAreTakenFromTheFirstTurns) {
  for (const std::string drift_rpm_h : {"0.5", "1.0", "2.0"}) {
    SCOPED_TRACE(drift_rpm_h);
    const Simulated simulated{
        "gto-nominal.toml",
        {{"rate_rpm = 60.0\n", "rate_rpm = 5.5\nrate_drift_rpm_h = " + drift_rpm_h + "\n"}},
        kCoded};
    const Processed processed{simulated.pass, {"--strict"}};
    EXPECT_GT(real_of(processed.db, "SELECT avg(accepted) FROM pulse_use"), 0.9);
    // There is one frame a turn, and every turn is counted.
    EXPECT_EQ(
        number_of(processed.db, "SELECT max(revolution) - min(revolution) + 1 FROM revolution"),
        count_rows(processed.db, "coded_frame") - 1);
    EXPECT_EQ(count_rows(processed.db, "pass_answer WHERE quality = 'OK'"), 3);
    for (const std::string estimator : {"mean", "sequential", "batch"}) {
      EXPECT_LT(off_deg(processed, estimator, simulated.pass), 0.06) << estimator;
    }
  }
}

TEST(Coded, SimulatedPassWithASilenceAndEveryFaultIsTelemetryThatCanBeTrue) {
  const Simulated simulated{"gto-dirty.toml", {}, kCoded};
  const Processed processed{simulated.pass, {"--strict"}};
  // 12 s are 12 turns at 60 rpm: so many consecutive sun1 are never lost, but the silence lasts a
  // minute.
  EXPECT_LT(real_of(processed.db, "SELECT max(period_s) FROM coded_frame"), 12.0);
}

TEST(Coded, SimulatedPassOfBothKindsIsPublishedAsBoth) {
  const Simulated simulated{"gto-nominal.toml", {}, "[telemetry]\nkind = \"both\"\n"};
  const Served served{simulated.pass, simulated.publish()};
  EXPECT_EQ(count_rows(served.db, "pulse"), 3600);
  EXPECT_EQ(count_rows(served.db, "coded_frame"), 600);
}

}  // namespace spindrift::coded_test
