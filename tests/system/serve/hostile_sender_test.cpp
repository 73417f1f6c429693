// Senders that publish wrong samples without end fill neither the disk nor the log.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/service.h"

namespace spindrift::hostile_sender_test {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(HostileSender, OfImpossibleSamplesFillsNoDiskAndIsCountedTruly) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  constexpr int kSent = 20'000;
  ForeignWriter sender{service.bus(), "impossible", kSent};
  ASSERT_EQ(sender.exit_status(), 0);
  ASSERT_EQ(service.stop(), 0) << service.program().log();

  EXPECT_EQ(nlohmann::json::parse(service.program().out())["runs"][0]["input_rejected"], kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT sum(samples) FROM rejected_input"), kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT sum(rejected) FROM rejection_summary"), kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT received FROM source_count"), kSent);
  // Up to 21 rows are kept a minute, and a slow machine needs two minutes.
  EXPECT_LE(number_of(service.db(), "SELECT count(*) FROM rejected_input"), 63);
  EXPECT_THAT(rows_of(service.db(), "SELECT reason FROM rejected_input WHERE samples > 1").front(),
              HasSubstr("are only counted, the last: pulses: t_tai_ns = -1"));

  // A restarted service continues the count.
  service.start();
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_EQ(service.stop(), 0) << service.program().log();
  EXPECT_EQ(nlohmann::json::parse(service.program().out())["runs"][0]["input_rejected"], kSent);
}

TEST(HostileSender, OfAnotherTypeOfTheSameNameIsLoggedOnce) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ForeignWriter sender{service.bus(), "foreign", 2000};
  ASSERT_EQ(sender.exit_status(), 0);
  ASSERT_EQ(service.stop(), 0) << service.program().log();
  const std::string log = service.program().log();
  EXPECT_THAT(log, HasSubstr("Cyclone DDS: "));
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 30) << log;
}

TEST(HostileSender, WhoseNamesAreForATerminalReachesNoLogWithThem) {
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  const auto participant = bus::Participant::create(service.bus()).value();
  auto sender = TelemetryPublisher<Pulse>::create(participant, "\x1b[2J\xff").value();
  ASSERT_TRUE(sender.wait_for_subscriber(30s));
  const Pulse pulse{.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::Sun1};
  ASSERT_TRUE(sender.publish("SPINNER", pulse, std::stop_token{}));
  ASSERT_TRUE(sender.publish("\x1b]0;x\x07", pulse, std::stop_token{}));
  ASSERT_TRUE(sender.wait_for_acknowledgments(30s));
  ASSERT_EQ(service.stop(), 0) << service.program().log();

  EXPECT_EQ(rows_of(service.db(), "SELECT source, received FROM source_count"),
            std::vector<std::string>{"\\x1b[2J\\xff|2|"});
  const auto rejected = rows_of(service.db(), "SELECT source, reason FROM rejected_input");
  ASSERT_EQ(rejected.size(), 2U);
  EXPECT_THAT(rejected[0] + rejected[1], HasSubstr("spacecraft = \"\\x1b]0;x\\x07\""));
  for (const std::string& text : {rejected[0], rejected[1], service.program().log()}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
  }
}

}  // namespace spindrift::hostile_sender_test
