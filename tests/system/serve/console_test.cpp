#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/http_client.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/pass_with.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"

namespace spindrift::serve_console_test {
namespace {

/// Runs a service with a console on a pass whose target attitude is far from the actual one.
class ServedConsole : public ::testing::Test {
 protected:
  ServedConsole() { start(); }
  void start() {
    service_.emplace(on(
        bus_, {"serve", "--mission", copy_.mission(), "--db", db(), "--console", "127.0.0.1:0"}));
    const std::string log = service_->log();
    const auto url = log.find("http://127.0.0.1:");
    ASSERT_LT(url, log.find("ready")) << log;
    client_.emplace(log.substr(url, log.find("/\n", url) - url));
  }
  void replay() const {
    succeeded(on(bus_, {"replay", "--mission", copy_.mission(), "--telemetry", copy_.folder.path(),
                        "--speed", "0"}));
  }
  void stop() { stop_in_order(*service_); }
  const std::filesystem::path& db() const { return copy_.db; }
  nlohmann::json shown() { return client_->get_json("/api/v1/state")["spacecraft"]["SPINNER"]; }

  const PassWith copy_{kOffTarget};
  const bus::BusConfig bus_ = bus_of_its_own();
  std::optional<Serving> service_;
  std::optional<HttpClient> client_;
};

TEST_F(ServedConsole, ShowsWhatTheArchiveHolds) {
  EXPECT_EQ(shown()["state"], "waiting");
  EXPECT_FALSE(shown().contains("quality"));
  replay();
  const auto is_of_verdict = [&] {
    const auto state = shown();
    return state.contains("ra_deg") && count_rows(db(), "revolution") > 590 &&
           state["ra_deg"] == real_of(db(), "SELECT ra_deg FROM pass_verdict") &&
           state["spin_rate_rpm"] == real_of(db(), "SELECT spin_rate_rpm FROM pass_verdict");
  };
  ASSERT_TRUE(eventually(is_of_verdict)) << shown() << service_->log();
  // Health, which comes once a second, tells how far the telemetry has come.
  ASSERT_TRUE(eventually([&] {
    const auto state = client_->get_json("/api/v1/state");
    return state["service"].value("samples_committed", 0) == 3600 &&
           state["spacecraft"]["SPINNER"].contains("sun_ra_deg");
  }));
  EXPECT_GT(shown()["to_target_deg"], 70.0);
  EXPECT_TRUE(shown()["sun_ra_deg"].is_number());
  const auto points = client_->get_json(
      "/api/v1/series?spacecraft=SPINNER&quantity=sun_angle&from=0&to=9000000000000000000"
      "&points=10000")["points"];
  EXPECT_EQ(points.size(), count_rows(db(),
                                      "spin_measurement JOIN revolution USING (run_id, revolution) "
                                      "WHERE quantity = 'sun_angle'"));
  EXPECT_THAT(client_->get("/metrics").body(),
              HasSubstr("spindrift_samples_committed_total 3600\n"));
  EventViewer missed = client_->watch("Last-Event-ID: 1\r\n");
  EXPECT_THAT(missed.until("event: pulse\n"), HasSubstr("id: "));
  stop();
}

TEST_F(ServedConsole, TakesAnAcknowledgementAndKnowsItAfterARestart) {
  replay();
  // There may be alerts of the service beside it.
  const auto off_target = [&] {
    const auto alerts = client_->get_json("/api/v1/state")["alerts"];
    const auto found = std::find_if(alerts.begin(), alerts.end(), [](const auto& alert) {
      return alert["key"] == "spin.off_target";
    });
    return found == alerts.end() ? nlohmann::json{} : *found;
  };
  ASSERT_TRUE(eventually([&] { return !off_target().is_null(); }));
  const auto alert = off_target();
  EXPECT_EQ(alert["evidence"]["unit"], "deg");
  std::optional<EventViewer> viewer = client_->watch();
  viewer->until("event: state\n");
  const std::string line = text_of(db().string() + ".token");
  const auto reply =
      client_->post("/api/v1/alerts/" + alert["alert_id"].get<std::string>() + "/ack",
                    R"({"by":"night shift","note":"seen"})", line.substr(0, line.size() - 1));
  ASSERT_EQ(reply.result_int(), 200U) << reply.body();
  viewer->until("event: alert\n");
  EXPECT_EQ(count_rows(db(), "alert_transition WHERE by = 'night shift'"), 1);
  stop();
  viewer.reset();  // The viewer must be destroyed before its client.
  start();
  EXPECT_EQ(off_target()["state"], "acknowledged");
  stop();
}

TEST_F(ServedConsole, ShowsTheRunOfBeforeUntilTheNextOneHasTelemetry) {
  replay();
  ASSERT_TRUE(eventually([&] { return count_rows(db(), "spin_estimate") > 590; }));
  stop();
  const std::int64_t first_arrival = number_of(db(), "SELECT first_arrival FROM run");
  copy_.add("# better known now\n");
  start();
  ASSERT_TRUE(eventually([&] { return shown().contains("quality"); })) << service_->log();
  EXPECT_EQ(count_rows(db(), "run"), 1);
  EXPECT_EQ(shown()["state"], "stale");
  EXPECT_EQ(shown()["t_tai_ns"], number_of(db(), "SELECT last_tai_ns FROM run"));
  EXPECT_EQ(shown()["ra_deg"], real_of(db(), "SELECT ra_deg FROM pass_verdict"));
  EXPECT_FALSE(shown()["estimates"].empty());
  EXPECT_FALSE(shown()["go"]["is_go"]);
  EXPECT_FALSE(client_
                   ->get_json("/api/v1/series?spacecraft=SPINNER&quantity=sun_angle&from=0"
                              "&to=9000000000000000000&points=100")["points"]
                   .empty());
  stop();  // A run without samples is not stored.
  EXPECT_EQ(count_rows(db(), "run"), 1);
  start();
  replay();
  ASSERT_TRUE(eventually([&] { return count_rows(db(), "run") == 2; }));
  ASSERT_TRUE(eventually([&] { return shown()["state"] == "live"; }));
  EXPECT_EQ(number_of(db(), fmt::format("SELECT count(*) FROM notice JOIN run USING (run_id) WHERE "
                                        "code = 'new_run' AND first_arrival > {}",
                                        first_arrival)),
            1);
  stop();
}

TEST_F(ServedConsole, ShowsResidualsThatTheArchiveDoesNotKeep) {
  stop();
  std::filesystem::remove(db());
  copy_.add("[archive]\nresiduals = false\n");
  start();
  EventViewer viewer = client_->watch();
  replay();
  ASSERT_TRUE(eventually([&] { return shown()["residuals"].size() > 2; })) << shown();
  EXPECT_THAT(viewer.until("\"off_unit\":\"sigma\""), HasSubstr("event: pulse\n"));
  EXPECT_GT(count_rows(db(), "pulse_use"), 0);
  EXPECT_EQ(count_rows(db(), "edge_residual"), 0);
  stop();
}

TEST_F(ServedConsole, EndsWithViewersConnected) {
  std::vector<EventViewer> viewers;
  for (int i = 0; i < 20; ++i) {
    viewers.push_back(client_->watch());
    viewers.back().until("event: state\n");
  }
  stop();
}

TEST(ServeConsole, RefusesWhatIsNoAddress) {
  const PassCopy copy{"nominal"};
  refused({"serve", "--mission", copy.mission(), "--db", copy.db, "--domain", "99", "--console",
           "ship"},
          {"--console ship: must be HOST:PORT"});
  EXPECT_FALSE(std::filesystem::exists(copy.db));
}

}  // namespace
}  // namespace spindrift::serve_console_test
