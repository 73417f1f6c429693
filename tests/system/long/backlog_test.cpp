// A service that is told to stop with most of a day's pass stored and not yet computed.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/test_paths.h"

namespace spindrift::backlog_test {

using namespace std::chrono_literals;

const std::filesystem::path kScenario = scenarios() / "geo-day.toml";

/// Looks every second, for five minutes at most.
template <class Condition>
bool comes(const Condition& condition) {
  for (int looks = 0; looks < 300; ++looks) {
    if (condition()) {
      return true;
    }
    std::this_thread::sleep_for(1s);
  }
  return false;
}

TEST(Backlog, IsComputedAtTheNextStartBitForBit) {
  const TemporaryFolder folder;
  const auto pass = folder.path() / "pass";
  const std::string mission = (pass / "mission.toml").string();
  const auto offline = folder.path() / "processed.db";
  const auto served = folder.path() / "served.db";
  Program simulate{{"simulate", kScenario.string(), "--out", pass.string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  Program process{
      {"process", "--mission", mission, "--telemetry", pass.string(), "--db", offline.string()}};
  ASSERT_EQ(process.exit_status(), 0) << process.log();

  const bus::BusConfig bus = bus_of_its_own();
  const auto on_bus = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(),
                     {"--domain", std::to_string(bus.domain), "--partition", bus.partition});
    return arguments;
  };
  const auto serve = on_bus({"serve", "--mission", mission, "--db", served.string()});
  {
    Program service{serve};
    ASSERT_TRUE(service.says("ready")) << service.log();
    Program replay{
        on_bus({"replay", "--mission", mission, "--telemetry", pass.string(), "--speed", "0"})};
    ASSERT_EQ(replay.exit_status(), 0) << replay.log();
    service.signal(SIGTERM);
    ASSERT_EQ(service.exit_status(), 0) << service.log();
    if (service.log().find("stored and not computed yet") == std::string::npos) {
      GTEST_SKIP() << "this machine leaves no backlog";
    }
  }
  const std::string pulses = "SELECT count(*) FROM pulse";
  EXPECT_EQ(number_of(served, pulses), number_of(offline, pulses));
  EXPECT_EQ(number_of(served, "SELECT count(*) FROM run WHERE finished_utc IS NULL"), 1);

  Program service{serve};
  // All but what the end of the pass settles.
  const std::int64_t revolutions = number_of(offline, "SELECT max(revolution) FROM revolution");
  EXPECT_TRUE(comes([&] {
    return number_of(served, "SELECT ifnull(max(revolution), 0) FROM revolution") >
           revolutions - 1000;
  })) << service.log();
  service.signal(SIGTERM);
  ASSERT_EQ(service.exit_status(), 0) << service.log();
  EXPECT_EQ(number_of(served, "SELECT count(*) FROM run WHERE finished_utc IS NULL"), 0);
  EXPECT_TRUE(product_rows(served) == product_rows(offline));  // Too many to print.
}

}  // namespace spindrift::backlog_test
