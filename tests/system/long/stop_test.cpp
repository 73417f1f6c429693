#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <list>
#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/service.h"

namespace spindrift::stop_test {

constexpr int kForEver = 1'000'000'000;
constexpr int kStops = 5;  // Number of stops of each kind.

/// Stops the service after it has stored some samples and prints how long that took.
/// @return Exit status.
int stop_in_the_middle(Service& service) {
  EXPECT_TRUE(
      eventually([&] { return number_of(service.db(), "SELECT count(*) FROM pulse") > 1000; }));
  const auto begun = std::chrono::steady_clock::now();
  const int status = service.stop();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  std::cout << "stopped in " << took.count() << " s\n";
  return status;
}

class StopUnderAFlood : public ::testing::TestWithParam<std::string> {};

TEST_P(StopUnderAFlood, EndsTheProcess) {
  for (int stop = 0; stop < kStops; ++stop) {
    Service service{"nominal"};
    ASSERT_TRUE(service.ready()) << service.program().log();
    std::list<ForeignWriter> writers;
    for (int i = 0; i < 4; ++i) {
      writers.emplace_back(service.bus(), GetParam(), kForEver);
    }
    EXPECT_EQ(stop_in_the_middle(service), 0) << service.program().log();
  }
}

INSTANTIATE_TEST_SUITE_P(Senders, StopUnderAFlood, ::testing::Values("telemetry", "patient"),
                         [](const auto& kind) { return kind.param; });

class StopUnderAReplay : public ::testing::TestWithParam<std::string> {};

TEST_P(StopUnderAReplay, EndsTheProcess) {
  const TemporaryFolder folder;
  Program simulate{
      {"simulate", (scenarios() / "geo-day.toml").string(), "--out", folder.path().string()}};
  ASSERT_EQ(simulate.exit_status(), 0) << simulate.log();
  for (int stop = 0; stop < kStops; ++stop) {
    Service service{folder.path().string()};
    ASSERT_TRUE(service.ready()) << service.program().log();
    Program replay{{"replay", "--mission", service.mission(), "--telemetry", folder.path().string(),
                    "--speed", GetParam(), "--domain", std::to_string(service.bus().domain),
                    "--partition", service.bus().partition}};
    EXPECT_EQ(stop_in_the_middle(service), 0) << service.program().log();
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, StopUnderAReplay, ::testing::Values("0", "720"),
                         [](const auto& speed) { return "Of" + speed.param; });

}  // namespace spindrift::stop_test
