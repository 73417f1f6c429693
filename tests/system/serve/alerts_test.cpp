#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spindrift.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/bus/qos.h"
#include "services/bus/reader.h"
#include "services/publisher/product_messages.h"
#include "tests/support/archive_rows.h"
#include "tests/support/processed_pass.h"
#include "tests/support/service.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::serve_alerts_test {

using ::testing::Each;
using ::testing::ElementsAre;

/// Holds a pass whose target attitude is far from the actual one.
struct OffTarget {
  PassCopy copy{"nominal"};
  OffTarget() {
    std::ofstream{copy.folder.path() / "mission.toml", std::ios::app}
        << "\n[spin.target]\nra_deg = 10.0\ndec_deg = 20.0\n";
  }
};

TEST(ServeAlerts, ArePublishedOnceOverARestartAndAcknowledgedThroughTheService) {
  const OffTarget pass;
  Service service{pass.copy.folder.path().string()};
  const auto participant = bus::Participant::create(service.bus()).value();
  const auto alerts = bus::Reader<spindrift_Alert>::create(participant, product_topic<Alert>(),
                                                           bus::telemetry_reader_qos())
                          .value();
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  const auto is_raised = [&] {
    return number_of(service.db(), "SELECT count(*) FROM alert WHERE key = 'spin.off_target'") == 1;
  };
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(0.5));
  ASSERT_TRUE(eventually(is_raised)) << service.program().log();
  service.program().signal(SIGKILL);
  ASSERT_EQ(service.program().exit_status(), -1);
  service.start();
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(1.0));

  const std::string row =
      rows_of(service.db(), "SELECT alert_id FROM alert WHERE key = 'spin.off_target'").front();
  const std::string id = row.substr(0, row.size() - 1);
  Program ack{
      {"alerts", "ack", id, "--by", "shift", "--note", "seen", "--db", service.db().string()}};
  ASSERT_EQ(ack.exit_status(), 0) << ack.log();
  std::vector<std::string> ids;
  std::vector<spindrift_AlertState> states;
  ASSERT_TRUE(eventually([&] {
    static_cast<void>(alerts.take([&](const spindrift_Alert& alert) {
      if (std::string{alert.dedupe_key} == "spin.off_target") {
        ids.emplace_back(alert.alert_id);
        states.push_back(alert.state);
      }
    }));
    return !states.empty() && states.back() == spindrift_ACKNOWLEDGED;
  }));
  EXPECT_THAT(ids, Each(id));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();
  EXPECT_EQ(rows_of(service.db(),
                    "SELECT key, state, revision, count FROM alert WHERE key LIKE 'spin.%'"),
            std::vector<std::string>{"spin.off_target|acknowledged|2|1|"});
}

/// Runs a service whose link counts as silent after a second, and collects what is published under
/// one key.
struct Watched {
  PassCopy copy{"nominal"};
  std::string key;
  std::optional<Service> service;
  std::optional<bus::Participant> participant;
  std::optional<bus::Reader<spindrift_Alert>> reader;
  std::optional<FrontEnd> front_end;
  std::vector<std::string> changes;  ///< State and revision of each change.
  std::vector<std::string> ids;      ///< Alert ID of each change.

  explicit Watched(std::string of_key) : key{std::move(of_key)} {
    std::ofstream{copy.folder.path() / "mission.toml", std::ios::app}
        << "\n[alerts.\"link.silent\"]\nseconds = 3.0\n";
    service.emplace(copy.folder.path().string());
    participant.emplace(bus::Participant::create(service->bus()).value());
    reader.emplace(bus::Reader<spindrift_Alert>::create(*participant, product_topic<Alert>(),
                                                        bus::telemetry_reader_qos())
                       .value());
    front_end.emplace(service->bus(), "SPINNER", pulses_of("nominal"));
  }

  bool is_published(const std::string& change) {
    return eventually([&] {
      static_cast<void>(reader->take([&](const spindrift_Alert& alert) {
        if (alert.dedupe_key == key) {
          changes.push_back(std::string{name_of(static_cast<AlertState>(alert.state))} + " " +
                            std::to_string(alert.revision));
          ids.emplace_back(alert.alert_id);
        }
      }));
      return std::find(changes.begin(), changes.end(), change) != changes.end();
    });
  }
  bool is_stored(const std::string& state) const {
    return eventually([&] {
      try {
        return rows_of(service->db(), "SELECT state FROM alert WHERE key = '" + key + "'") ==
               std::vector<std::string>{state + "|"};
      } catch (const SQLite::Exception&) {
        return false;
      }
    });
  }
};

TEST(ServeAlerts, OfSilenceGoOnOverARestartUntilTelemetryIsBack) {
  Watched link{"link.silent"};
  ASSERT_TRUE(link.service->ready()) << link.service->log();
  ASSERT_TRUE(link.front_end->send_until(0.1));
  ASSERT_TRUE(link.is_published("active 1")) << link.service->log();
  ASSERT_TRUE(link.is_stored("active"));
  link.service->program().signal(SIGKILL);
  ASSERT_EQ(link.service->program().exit_status(), -1);
  link.service->start();
  ASSERT_TRUE(link.service->ready()) << link.service->log();
  ASSERT_TRUE(link.front_end->send_until(0.2));
  ASSERT_TRUE(link.is_published("cleared 2"))
      << ::testing::PrintToString(link.changes) << link.service->log();
  const auto cleared = std::find(link.changes.begin(), link.changes.end(), "cleared 2");
  EXPECT_THAT(
      std::vector(link.ids.begin(), link.ids.begin() + (cleared - link.changes.begin()) + 1),
      Each(link.ids.front()));
  EXPECT_EQ(link.service->stop_when_computed(), 0) << link.service->log();
}

TEST(ServeAlerts, OfAnArchiveThatFailsArePublishedAtOnceAndStoredAfterwards) {
  namespace fs = std::filesystem;
  Watched archive{"archive.write"};
  const fs::path db = archive.service->db();
  const fs::path other = db.string() + ".other";
  ASSERT_TRUE(archive.service->ready()) << archive.service->log();
  ASSERT_TRUE(archive.front_end->send_until(0.1));
  ASSERT_TRUE(eventually([&] { return number_of(db, "SELECT count(*) FROM spin_fix") > 10; }));
  std::ofstream{other} << std::string(10'000, 'x');
  fs::rename(other, db);
  EXPECT_TRUE(archive.is_published("active 1")) << archive.service->log();
  fs::rename(db, other);
  EXPECT_TRUE(archive.is_published("cleared 2")) << archive.service->log();
  EXPECT_TRUE(archive.is_stored("cleared"));
  EXPECT_EQ(archive.changes, (std::vector<std::string>{"active 1", "cleared 2"}));
  EXPECT_EQ(archive.service->stop_when_computed(), 0) << archive.service->log();
}

TEST(ServeAlerts, DoNotTakeARehearsalForLateTelemetry) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.log();
  {
    const Program rehearsal{{"replay", "--now", "--mission", service.mission(), "--telemetry",
                             (kPasses / "nominal").string(), "--domain",
                             std::to_string(service.bus().domain), "--partition",
                             service.bus().partition}};
    ASSERT_TRUE(eventually([&] {
      return number_of(service.db(), "SELECT count(*) FROM spin_fix") > 8;
    })) << service.log()
        << rehearsal.log();
  }
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM alert WHERE key = 'link.late'"), 0);
  EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
}

TEST(ServeAlerts, SayThatTheFieldOfAMagnetometerEndsWithinADay) {
  const TemporaryFolder folder;
  // TAI time of a noon before 2030.
  const auto scenario = folder.write(
      "scenario.toml",
      replaced(text_of(scenarios() / "separation.toml"),
               {{"start_utc = \"2026-03-01T04:00:00Z\"", "start_tai_ns = 1893412800000000000"}}) +
          "[three_axis.magnetometer]\nnoise_nt = 100\n");
  const std::filesystem::path pass = folder.path() / "pass";
  Program simulate{{"simulate", scenario.string(), "--out", pass.string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  Service service{pass.string(), "replay"};
  ASSERT_TRUE(service.ready()) << service.log();
  {
    const Program rehearsal{{"replay", "--now", "--mission", service.mission(), "--telemetry",
                             pass.string(), "--domain", std::to_string(service.bus().domain),
                             "--partition", service.bus().partition}};
    EXPECT_TRUE(eventually([&] {
      return number_of(service.db(),
                       "SELECT count(*) FROM alert"
                       " WHERE key = 'data.outdated:field_coefficients'") == 1;
    })) << service.log()
        << rehearsal.log();
  }
  EXPECT_EQ(service.stop_when_computed(), 0) << service.log();
}

TEST(ServeAlerts, SayThatAnotherServicePublishesTheSameSpacecraft) {
  Watched twice{"service.twice"};
  const TemporaryFolder folder;
  Program other{{"serve", "--mission", twice.service->mission(), "--db",
                 (folder.path() / "other.db").string(), "--domain",
                 std::to_string(twice.service->bus().domain), "--partition",
                 twice.service->bus().partition}};
  ASSERT_TRUE(twice.service->ready()) << twice.service->log();
  ASSERT_TRUE(other.says("ready")) << other.log();
  ASSERT_TRUE(twice.front_end->send_until(0.1));
  EXPECT_TRUE(twice.is_published("active 1")) << twice.service->log();
  other.signal(SIGTERM);
  EXPECT_EQ(other.exit_status(), 0) << other.log();
  EXPECT_TRUE(twice.is_published("cleared 2")) << twice.service->log();
  EXPECT_EQ(twice.service->stop_when_computed(), 0) << twice.service->log();
}

/// Simulates a pass that spins slightly faster than the model named in its mission.
std::filesystem::path pass_off_its_model(const TemporaryFolder& folder) {
  const auto nominal = scenarios() / "gto-nominal.toml";
  const auto pass = folder.path() / "pass";
  Program simulate{
      {"simulate",
       folder.write("faster.toml", replaced(text_of(nominal), {{"rpm = 60.0", "rpm = 60.1"}}))
           .string(),
       "--out", pass.string()}};
  EXPECT_EQ(simulate.exit_status(), 0) << simulate.log();
  std::ofstream{pass / "mission.toml", std::ios::app} << "\n[ground_model]\nscenario = \""
                                                      << nominal.string() << "\"\n";
  return pass;
}

TEST(ServeAlerts, AreOfTheGroundModelTheSameAsOfFilesOverARestart) {
  const TemporaryFolder folder;
  const auto pass = pass_off_its_model(folder);
  const std::string query =
      "SELECT key, raised_tai_ns, evidence, message, count FROM alert WHERE key LIKE 'model.%'";
  const auto expected = rows_of(process(folder, pass).db, query);
  ASSERT_EQ(expected.size(), 1U);
  Service service{pass.string()};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of(pass.string())};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(0.01));
  ASSERT_TRUE(eventually([&] {
    return number_of(service.db(), "SELECT count(*) FROM pulse") > 20;
  })) << service.program().log();
  service.program().signal(SIGKILL);
  ASSERT_EQ(service.program().exit_status(), -1);
  service.start();
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(1.0));
  EXPECT_TRUE(eventually([&] { return rows_of(service.db(), query) == expected; }))
      << service.program().log();
}

}  // namespace spindrift::serve_alerts_test
