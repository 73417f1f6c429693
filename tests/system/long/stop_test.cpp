#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <list>
#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/on_bus.h"
#include "tests/support/ran.h"
#include "tests/support/service.h"

namespace spindrift::stop_test {

constexpr int kForEver = 1'000'000'000;
constexpr int kStops = 5;  // Number of stops of each kind.

/// Stops the service after it has stored some samples and prints how long that took.
/// @return Exit status.
int stop_in_the_middle(Service& service) {
  EXPECT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") > 1000; }));
  const auto begun = std::chrono::steady_clock::now();
  const int status = service.stop();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  std::cout << "stopped in " << took.count() << " s\n";
  return status;
}

class StopUnderAFlood : public ::testing::TestWithParam<std::string> {};

TEST_P(StopUnderAFlood, EndsTheProcess) {
  for (int stop = 0; stop < kStops; ++stop) {
    ReadyService service{"nominal"};
    std::list<ForeignWriter> writers;
    for (int i = 0; i < 4; ++i) {
      writers.emplace_back(service.bus(), GetParam(), kForEver);
    }
    EXPECT_EQ(stop_in_the_middle(service), 0) << service.log();
  }
}

INSTANTIATE_TEST_SUITE_P(Senders, StopUnderAFlood, ::testing::Values("telemetry", "patient"),
                         [](const auto& kind) { return kind.param; });

class StopUnderAReplay : public ::testing::TestWithParam<std::string> {};

TEST_P(StopUnderAReplay, EndsTheProcess) {
  const TemporaryFolder folder;
  succeeded({"simulate", scenarios() / "geo-day.toml", "--out", folder.path()});
  for (int stop = 0; stop < kStops; ++stop) {
    ReadyService service{folder.path().string()};
    Program replay{service.words({"replay", "--telemetry", folder.path(), "--speed", GetParam()})};
    EXPECT_EQ(stop_in_the_middle(service), 0) << service.log();
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, StopUnderAReplay, ::testing::Values("0", "720"),
                         [](const auto& speed) { return "Of" + speed.param; });

}  // namespace spindrift::stop_test
