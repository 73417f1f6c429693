// Services that are stopped or killed with most of a long pass stored but not yet computed.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/on_bus.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::backlog_test {

using namespace std::chrono_literals;

const std::filesystem::path kScenario = scenarios() / "geo-day.toml";

/// Polls the condition every second for up to five minutes.
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
  succeeded({"simulate", kScenario, "--out", pass});
  succeeded({"process", "--mission", mission, "--telemetry", pass, "--db", offline});

  const bus::BusConfig bus = bus_of_its_own();
  const auto serve = on(bus, {"serve", "--mission", mission, "--db", served});
  {
    Serving service{serve};
    succeeded(on(bus, {"replay", "--mission", mission, "--telemetry", pass, "--speed", "0"}));
    stop_in_order(service);
    if (service.log().find("stored and not computed yet") == std::string::npos) {
      GTEST_SKIP() << "this machine leaves no backlog";
    }
  }
  const std::string pulses = "SELECT count(*) FROM pulse";
  EXPECT_EQ(number_of(served, pulses), number_of(offline, pulses));
  EXPECT_EQ(count_rows(served, "run WHERE finished_utc IS NULL"), 1);

  Program service{serve};
  // The last revolutions are computed only at the end of the pass.
  const std::int64_t revolutions = number_of(offline, "SELECT max(revolution) FROM revolution");
  EXPECT_TRUE(comes([&] {
    return number_of(served, "SELECT ifnull(max(revolution), 0) FROM revolution") >
           revolutions - 1000;
  })) << service.log();
  stop_in_order(service);
  EXPECT_EQ(count_rows(served, "run WHERE finished_utc IS NULL"), 0);
  EXPECT_TRUE(product_rows(served) == product_rows(offline));  // The rows are too many to print.
}

/// Simulates the first two hours of the day.
std::string two_hours_in(const std::filesystem::path& folder) {
  std::string scenario = text_of(kScenario);
  const std::string day = "duration_s = 86400.0";
  scenario.replace(scenario.find(day), day.size(), "duration_s = 7200.0");
  const auto path = folder / "two-hours.toml";
  std::ofstream{path} << scenario;
  return path.string();
}

class Backlogged {
 public:
  Backlogged(std::string mission, std::filesystem::path db)
      : mission_{std::move(mission)}, db_{std::move(db)}, bus_{bus_of_its_own()} {
    start();
  }

  void start() { service_.emplace(on(bus_, {"serve", "--mission", mission_, "--db", db_})); }
  Program& service() { return *service_; }

  /// Replays the pass.
  /// @return Whether the service has stored all edges.
  bool takes(const std::filesystem::path& pass, std::int64_t edges) {
    Program replay{
        on(bus_, {"replay", "--mission", mission_, "--telemetry", pass, "--speed", "0"})};
    return replay.exit_status() == 0 && has("pulse", edges);
  }

  /// Stops the service once it has this many solutions, and restarts it while it leaves work.
  bool computes_all(std::int64_t solutions) {
    for (int stops = 0; stops < 20; ++stops) {
      if (!service().says("ready") || !has("spin_batch", solutions)) {
        return false;
      }
      service().signal(SIGTERM);
      if (service().exit_status() != 0) {
        return false;
      }
      if (service().log().find("not computed yet") == std::string::npos) {
        return true;
      }
      start();
    }
    return false;
  }

  bool has(const std::string& table, std::int64_t rows) {
    return comes([&] { return count_rows(db_, "" + table) >= rows; });
  }

 private:
  std::string mission_;
  std::filesystem::path db_;
  bus::BusConfig bus_;
  std::optional<Program> service_;
};

TEST(Backlog, KilledAtTwentyRandomInstantsGivesWhatNoKillWouldHave) {
  constexpr std::int64_t kEdges = 72'000;
  constexpr std::int64_t kSolutions = 119;
  const TemporaryFolder folder;
  const auto pass = folder.path() / "pass";
  succeeded({"simulate", two_hours_in(folder.path()), "--out", pass});
  const std::string mission = (pass / "mission.toml").string();
  const auto whole_db = folder.path() / "whole.db";
  const auto killed_db = folder.path() / "killed.db";

  Backlogged whole{mission, whole_db};
  ASSERT_TRUE(whole.service().says("ready")) << whole.service().log();
  ASSERT_TRUE(whole.takes(pass, kEdges));
  ASSERT_TRUE(whole.computes_all(kSolutions)) << whole.service().log();

  Backlogged killed{mission, killed_db};
  ASSERT_TRUE(killed.service().says("ready")) << killed.service().log();
  ASSERT_TRUE(killed.takes(pass, kEdges));
  std::minstd_rand random{21};
  for (int round = 0; round < 20; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds{random() % 4000U});
    killed.service().signal(SIGKILL);
    ASSERT_EQ(killed.service().exit_status(), -1);
    killed.start();
    ASSERT_TRUE(killed.service().says("ready")) << killed.service().log();
  }
  ASSERT_TRUE(killed.computes_all(kSolutions)) << killed.service().log();
  EXPECT_TRUE(all_rows(killed_db) == all_rows(whole_db));  // The rows are too many to print.
}

}  // namespace spindrift::backlog_test
