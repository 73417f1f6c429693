// The memory of a service that takes the telemetry of twenty spacecraft as fast as it can.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <limits>
#include <list>
#include <string>
#include <thread>

#include "tests/support/archive_rows.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"
#include "tests/support/simulated.h"

namespace spindrift::memory_test {

constexpr int kSpacecraft = 20;
constexpr std::int64_t kSolutions = 499;  ///< Each spacecraft gives one a minute of telemetry.

TEST(Memory, OfAServiceIsFlatFromATenthOfTheTelemetryOn) {
  if (is_sanitized()) {
    GTEST_SKIP() << "sanitizers need memory of their own";
  }
  const Simulated pass{
      "geo-day.toml",
      {{"duration_s = 86400.0", "duration_s = 30000.0"}, {"rate_rpm = 100.0", "rate_rpm = 200.0"}}};
  const TemporaryFolder folder;
  const bus::BusConfig bus = bus_of_its_own();
  const std::string db = folder.path() / "served.db";
  Words missions;
  for (int i = 0; i < kSpacecraft; ++i) {
    missions.push_back(
        folder.write(fmt::format("{}.toml", i),
                     replaced(text_of(pass.mission()), {{"'WEATHER'", fmt::format("'SC{}'", i)},
                                                        {"orbit.oem", pass.pass / "orbit.oem"}})));
  }
  Words serve{"serve", "--db", db};
  std::list<Program> senders;
  for (const std::string& mission : missions) {
    serve = with(serve, {"--mission", mission});
  }
  Serving service{on(bus, serve)};
  for (const std::string& mission : missions) {
    senders.emplace_back(
        on(bus, {"replay", "--mission", mission, "--telemetry", pass.pass, "--speed", "0"}));
  }
  long least_kib = std::numeric_limits<long>::max();
  long most_kib = 0;
  for (std::int64_t solved = 0; solved < kSpacecraft * kSolutions;) {
    std::this_thread::sleep_for(std::chrono::seconds{1});
    solved = count_rows(db, "spin_batch");
    if (solved >= kSpacecraft * kSolutions / 10) {
      least_kib = std::min(least_kib, service.memory_kib());
      most_kib = std::max(most_kib, service.memory_kib());
    }
  }
  std::cout << least_kib << " to " << most_kib << " KiB\n";
  EXPECT_LT(static_cast<double>(most_kib), 1.1 * static_cast<double>(least_kib));
  for (Program& sender : senders) {
    EXPECT_EQ(sender.exit_status(), 0) << sender.log();
  }
}

}  // namespace spindrift::memory_test
