#include <gtest/gtest.h>

#include <csignal>
#include <list>
#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/service.h"

namespace spindrift::serve_stop_test {

constexpr int kForEver = 1'000'000'000;

class ServeStop : public ::testing::TestWithParam<std::string> {};

TEST_P(ServeStop, EndsHoweverFastSendersGoOn) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  std::list<ForeignWriter> writers;
  for (int i = 0; i < 3; ++i) {
    writers.emplace_back(service.bus(), GetParam(), kForEver);
  }
  ASSERT_TRUE(
      eventually([&] { return number_of(service.db(), "SELECT count(*) FROM pulse") > 10'000; }));
  EXPECT_EQ(service.stop(), 0) << service.program().log();
}

INSTANTIATE_TEST_SUITE_P(Senders, ServeStop, ::testing::Values("telemetry", "patient"),
                         [](const auto& kind) { return kind.param; });

TEST(Serve, StopsInAnOrderlyWayWhenItsTerminalHangsUp) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  service.program().signal(SIGHUP);
  ASSERT_EQ(service.program().exit_status(), 0) << service.program().log();
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM run WHERE finished_utc IS NOT NULL"), 1);
}

TEST(Serve, GoesOnWithoutItsTerminalUnderNohup) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  Service service{"nominal"};
  std::signal(SIGHUP, before);
  ASSERT_TRUE(service.ready()) << service.program().log();
  service.program().signal(SIGHUP);
  EXPECT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.stop(), 0) << service.program().log();
  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM pulse"), 3600);
}

}  // namespace spindrift::serve_stop_test
