#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"

namespace spindrift::replay_test {

const std::string kPass = (recorded_passes() / "nominal").string();
const std::string kMission = kPass + "/mission.toml";
const std::string kScenario = (scenarios() / "gto-nominal.toml").string();

/// Commands that publish ten minutes of telemetry in ten minutes.
const std::vector<std::vector<std::string>> kSenders = {
    {"replay", "--mission", kMission, "--telemetry", kPass, "--json"},
    {"simulate", kScenario, "--publish", "--json"}};

TEST(Sending, ToldToStopSaysHowFarItCameAndEndsWithOne) {
  for (const auto& sender : kSenders) {
    for (const int signal : {SIGINT, SIGTERM}) {
      SCOPED_TRACE(sender.front());
      ReadyService service{"nominal"};
      Program sending{on(service.bus(), sender)};
      ASSERT_TRUE(sending.says("publishing")) << sending.log();
      ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") > 0; }));
      sending.signal(signal);
      EXPECT_EQ(sending.exit_status(), 1);
      ASSERT_EQ(service.stop(), 0) << service.log();

      const auto stored = count_rows(service.db(), "pulse");
      const std::string error = nlohmann::json::parse(sending.out()).at("error");
      EXPECT_THAT(error, HasSubstr("stopped by a signal: " + std::to_string(stored) +
                                   " edges published, up to telemetry of "
                                   "2026-11-20T03:0"));
      EXPECT_THAT(sending.log(), HasSubstr(error));
    }
  }
}

TEST(Sending, SaysThatItWaitsForASubscriberAndEndsAtOnceWhenToldTo) {
  for (const auto& sender : kSenders) {
    const bus::BusConfig bus = bus_of_its_own();
    Program sending{on(bus, sender)};
    ASSERT_TRUE(sending.says(fmt::format("waiting for a subscriber in domain {}, partition '{}'",
                                         bus.domain, bus.partition)))
        << sending.log();
    sending.signal(SIGINT);
    EXPECT_EQ(sending.exit_status(), 1);
    EXPECT_THAT(sending.log(), HasSubstr("stopped by a signal: 0 edges"));
  }
}

/// Expects no carriage returns and escapes, which are for terminals and would corrupt a log.
void expect_plain(const std::string& text) {
  EXPECT_EQ(text.find_first_of("\r\x1b"), std::string::npos) << text;
}

TEST(Sending, DrawsNothingInAPipe) {
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  Serving service{on(bus, {"serve", "--mission", kMission, "--db", folder.path() / "served.db"})};
  for (std::vector<std::string> sender : kSenders) {
    sender.insert(sender.end(), {"--speed", "0"});
    const Ran sending = succeeded(on(bus, sender));
    expect_plain(sending.log);
    EXPECT_EQ(sending.json()["published"], 3600);
  }
  stop_in_order(service);
  expect_plain(service.log());
}

TEST(Process, DrawsNothingInAPipe) {
  const TemporaryFolder folder;
  const Ran process = succeeded(
      {"process", "--mission", kMission, "--telemetry", kPass, "--db", folder.path() / "out.db"});
  expect_plain(process.log);
  expect_plain(process.out);
}

}  // namespace spindrift::replay_test
