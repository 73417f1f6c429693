// Alerts of `spindrift serve`: on the bus, over a restart, acknowledged through the service.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spindrift.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include "services/bus/qos.h"
#include "services/bus/reader.h"
#include "services/publisher/product_messages.h"
#include "tests/support/archive_rows.h"
#include "tests/support/service.h"

namespace spindrift::serve_alerts_test {

using ::testing::Each;
using ::testing::ElementsAre;

/// A pass of which the target is elsewhere.
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

  const std::string row = rows_of(service.db(), "SELECT alert_id FROM alert").front();
  const std::string id = row.substr(0, row.size() - 1);
  Program ack{
      {"alerts", "ack", id, "--by", "shift", "--note", "seen", "--db", service.db().string()}};
  ASSERT_EQ(ack.exit_status(), 0) << ack.log();
  std::vector<std::string> ids;
  std::vector<spindrift_AlertState> states;
  ASSERT_TRUE(eventually([&] {
    static_cast<void>(alerts.take([&](const spindrift_Alert& alert) {
      ids.emplace_back(alert.alert_id);
      states.push_back(alert.state);
    }));
    return !states.empty() && states.back() == spindrift_ACKNOWLEDGED;
  }));
  EXPECT_THAT(ids, Each(id));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();
  EXPECT_EQ(rows_of(service.db(), "SELECT key, state, revision, count FROM alert"),
            std::vector<std::string>{"spin.off_target|acknowledged|2|1|"});
}

}  // namespace spindrift::serve_alerts_test
