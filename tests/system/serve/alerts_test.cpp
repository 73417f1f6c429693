#include <spindrift.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "services/bus/qos.h"
#include "services/publisher/product_messages.h"
#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/pass_with.h"
#include "tests/support/processed.h"
#include "tests/support/ran.h"
#include "tests/support/simulated.h"
#include "tests/support/subscriber.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::serve_alerts_test {

TEST(ServeAlerts, ArePublishedOnceOverARestartAndAcknowledgedThroughTheService) {
  const PassWith pass{kOffTarget};
  ReadyService service{pass.folder.path()};
  const Subscriber alerts{service.bus(), product_topic<Alert>(), bus::telemetry_reader_qos()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  const auto is_raised = [&] {
    return count_rows(service.db(), "alert WHERE key = 'spin.off_target'") == 1;
  };
  ASSERT_TRUE(front_end.send_until(0.5));
  ASSERT_TRUE(eventually(is_raised)) << service.log();
  service.kill_and_go_on();
  ASSERT_TRUE(front_end.send_until(1.0));

  const std::string row =
      rows_of(service.db(), "SELECT alert_id FROM alert WHERE key = 'spin.off_target'").front();
  const std::string id = row.substr(0, row.size() - 1);
  succeeded({"alerts", "ack", id, "--by", "shift", "--note", "seen", "--db", service.db()});
  std::vector<std::string> ids;
  std::vector<spindrift_AlertState> states;
  ASSERT_TRUE(eventually([&] {
    alerts.take([&](const spindrift_Alert& alert) {
      if (std::string{alert.dedupe_key} == "spin.off_target") {
        ids.emplace_back(alert.alert_id);
        states.push_back(alert.state);
      }
    });
    return !states.empty() && states.back() == spindrift_ACKNOWLEDGED;
  }));
  EXPECT_THAT(ids, Each(id));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
  EXPECT_THAT(rows_of(service.db(),
                      "SELECT key, state, revision, count FROM alert WHERE key LIKE 'spin.%'"),
              ElementsAre("spin.off_target|acknowledged|2|1|"));
}

/// Runs a service whose link counts as silent after a second, and collects what is published under
/// one key.
struct Watched {
  std::string key;
  PassWith pass{kSoonSilent};
  ReadyService service{pass.folder.path()};
  Subscriber<spindrift_Alert> subscriber{service.bus(), product_topic<Alert>(),
                                         bus::telemetry_reader_qos()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  std::vector<std::string> changes = {};  ///< State and revision of each change.
  std::vector<std::string> ids = {};      ///< Alert ID of each change.

  bool is_published(const std::string& change) {
    return eventually([&] {
      subscriber.take([&](const spindrift_Alert& alert) {
        if (alert.dedupe_key == key) {
          changes.push_back(std::string{name_of(static_cast<AlertState>(alert.state))} + " " +
                            std::to_string(alert.revision));
          ids.emplace_back(alert.alert_id);
        }
      });
      return std::find(changes.begin(), changes.end(), change) != changes.end();
    });
  }
  bool is_stored(const std::string& state) const {
    return eventually([&] {
      try {
        return rows_of(service.db(), "SELECT state FROM alert WHERE key = '" + key + "'") ==
               std::vector<std::string>{state + "|"};
      } catch (const SQLite::Exception&) {
        return false;
      }
    });
  }
};

TEST(ServeAlerts, OfSilenceGoOnOverARestartUntilTelemetryIsBack) {
  Watched link{"link.silent"};
  ASSERT_TRUE(link.front_end.send_until(0.1));
  ASSERT_TRUE(link.is_published("active 1")) << link.service.log();
  ASSERT_TRUE(link.is_stored("active"));
  link.service.kill_and_go_on();
  ASSERT_TRUE(link.front_end.send_until(0.2));
  ASSERT_TRUE(link.is_published("cleared 2"))
      << ::testing::PrintToString(link.changes) << link.service.log();
  const auto cleared = std::find(link.changes.begin(), link.changes.end(), "cleared 2");
  EXPECT_THAT(
      std::vector(link.ids.begin(), link.ids.begin() + (cleared - link.changes.begin()) + 1),
      Each(link.ids.front()));
  EXPECT_EQ(link.service.stop_when_computed(), 0) << link.service.log();
}

TEST(ServeAlerts, OfAnArchiveThatFailsArePublishedAtOnceAndStoredAfterwards) {
  namespace fs = std::filesystem;
  Watched archive{"archive.write"};
  const fs::path db = archive.service.db();
  const fs::path other = db.string() + ".other";
  ASSERT_TRUE(archive.front_end.send_until(0.1));
  ASSERT_TRUE(eventually([&] { return count_rows(db, "spin_fix") > 10; }));
  std::ofstream{other} << std::string(10'000, 'x');
  fs::rename(other, db);
  EXPECT_TRUE(archive.is_published("active 1")) << archive.service.log();
  fs::rename(db, other);
  EXPECT_TRUE(archive.is_published("cleared 2")) << archive.service.log();
  EXPECT_TRUE(archive.is_stored("cleared"));
  EXPECT_THAT(archive.changes, ElementsAre("active 1", "cleared 2"));
  EXPECT_EQ(archive.service.stop_when_computed(), 0) << archive.service.log();
}

TEST(ServeAlerts, DoNotTakeARehearsalForLateTelemetry) {
  ReadyService service{"nominal"};
  {
    const Program rehearsal{service.words({"replay", "--now", "--telemetry", kPasses / "nominal"})};
    ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "spin_fix") > 8; }))
        << service.log() << rehearsal.log();
  }
  EXPECT_EQ(count_rows(service.db(), "alert WHERE key = 'link.late'"), 0);
  EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
}

TEST(ServeAlerts, SayThatTheFieldOfAMagnetometerEndsWithinADay) {
  // TAI time of a noon before 2030.
  const Simulated simulated{
      "separation.toml",
      {{"start_utc = \"2026-03-01T04:00:00Z\"", "start_tai_ns = 1893412800000000000"}},
      "[three_axis.magnetometer]\nnoise_nt = 100\n"};
  const auto& pass = simulated.pass;
  ReadyService service{pass.string(), "replay"};
  {
    const Program rehearsal{service.words({"replay", "--now", "--telemetry", pass})};
    EXPECT_TRUE(eventually([&] {
      return count_rows(service.db(), "alert WHERE key = 'data.outdated:field_coefficients'") == 1;
    })) << service.log()
        << rehearsal.log();
  }
  EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
}

TEST(ServeAlerts, SayThatAnotherServicePublishesTheSameSpacecraft) {
  Watched twice{"service.twice"};
  const TemporaryFolder folder;
  Serving other{twice.service.words({"serve", "--db", folder.path() / "other.db"})};
  ASSERT_TRUE(twice.front_end.send_until(0.1));
  EXPECT_TRUE(twice.is_published("active 1")) << twice.service.log();
  stop_in_order(other);
  EXPECT_TRUE(twice.is_published("cleared 2")) << twice.service.log();
  EXPECT_EQ(twice.service.stop_when_computed(), 0) << twice.service.log();
}

TEST(ServeAlerts, AreOfTheGroundModelTheSameAsOfFilesOverARestart) {
  const Simulated faster{"gto-nominal.toml", {{"rpm = 60.0", "rpm = 60.1"}}};
  const auto& pass = faster.pass;
  std::ofstream{faster.mission(), std::ios::app}
      << "\n[ground_model]\nscenario = \"" << (scenarios() / "gto-nominal.toml").string() << "\"\n";
  const std::string query =
      "SELECT key, raised_tai_ns, evidence, message, count FROM alert WHERE key LIKE 'model.%'";
  const auto expected = rows_of(Processed{pass}.db, query);
  ASSERT_EQ(expected.size(), 1U);
  ReadyService service{pass.string()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of(pass.string())};
  ASSERT_TRUE(front_end.send_until(0.01));
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") > 20; })) << service.log();
  service.kill_and_go_on();
  ASSERT_TRUE(front_end.send_until(1.0));
  EXPECT_TRUE(eventually([&] { return rows_of(service.db(), query) == expected; }))
      << service.log();
}

}  // namespace spindrift::serve_alerts_test
