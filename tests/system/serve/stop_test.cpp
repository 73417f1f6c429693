#include <gtest/gtest.h>

#include <csignal>
#include <list>
#include <string>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_child.h"
#include "tests/support/on_bus.h"
#include "tests/support/service.h"

namespace spindrift::serve_stop_test {

constexpr int kForEver = 1'000'000'000;

class ServeStop : public ::testing::TestWithParam<std::string> {};

TEST_P(ServeStop, EndsHoweverFastSendersGoOn) {
  ReadyService service{"nominal"};
  std::list<ForeignWriter> writers;
  for (int i = 0; i < 3; ++i) {
    writers.emplace_back(service.bus(), GetParam(), kForEver);
  }
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "pulse") > 10'000; }));
  EXPECT_EQ(service.stop(), 0) << service.log();
}

INSTANTIATE_TEST_SUITE_P(Senders, ServeStop, ::testing::Values("telemetry", "patient"),
                         [](const auto& kind) { return kind.param; });

TEST(Serve, StopsInAnOrderlyWayWhenItIsInterruptedOrItsTerminalHangsUp) {
  for (const int signal : {SIGINT, SIGHUP}) {
    ReadyService service{"nominal"};
    service.program().signal(signal);
    ASSERT_EQ(service.program().exit_status(), 0) << service.log();
    EXPECT_EQ(count_rows(service.db(), "run WHERE mode = 'live' AND finished_utc IS NOT NULL"), 1);
  }
}

TEST(Serve, GoesOnWithoutItsTerminalUnderNohup) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  Service service{"nominal"};
  std::signal(SIGHUP, before);
  ASSERT_TRUE(service.ready()) << service.log();
  service.program().signal(SIGHUP);
  EXPECT_EQ(service.replay("0"), 0);
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_EQ(count_rows(service.db(), "pulse"), 3600);
}

}  // namespace spindrift::serve_stop_test
