// Senders that publish wrong samples without end fill neither the disk nor the log.

#include <algorithm>

#include "services/publisher/telemetry_publisher.h"
#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"

namespace spindrift::hostile_sender_test {

using namespace std::chrono_literals;

TEST(HostileSender, OfImpossibleSamplesFillsNoDiskAndIsCountedTruly) {
  ReadyService service{"nominal"};
  constexpr int kSent = 20'000;
  ForeignWriter sender{service.bus(), "impossible", kSent};
  ASSERT_EQ(sender.exit_status(), 0);
  ASSERT_EQ(service.stop(), 0) << service.log();

  EXPECT_EQ(service.summary()["runs"][0]["input_rejected"], kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT sum(samples) FROM rejected_input"), kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT sum(rejected) FROM rejection_summary"), kSent);
  EXPECT_EQ(number_of(service.db(), "SELECT received FROM source_count"), kSent);
  // Up to 21 rows are kept a minute, and a slow machine needs two minutes.
  EXPECT_LE(count_rows(service.db(), "rejected_input"), 63);
  EXPECT_THAT(rows_of(service.db(), "SELECT reason FROM rejected_input WHERE samples > 1").front(),
              HasSubstr("are only counted, the last: pulses: t_tai_ns = -1"));

  // A restarted service continues the count.
  service.go_on();
  ASSERT_EQ(service.stop(), 0) << service.log();
  EXPECT_EQ(service.summary()["runs"][0]["input_rejected"], kSent);
}

TEST(HostileSender, OfAnotherTypeOfTheSameNameIsLoggedOnce) {
  ReadyService service{"nominal"};
  ForeignWriter sender{service.bus(), "foreign", 2000};
  ASSERT_EQ(sender.exit_status(), 0);
  ASSERT_EQ(service.stop(), 0) << service.log();
  const std::string log = service.program().log();
  EXPECT_THAT(log, HasSubstr("Cyclone DDS: "));
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 30) << log;
}

TEST(HostileSender, WhoseNamesAreForATerminalReachesNoLogWithThem) {
  ReadyService service{"nominal"};
  const auto participant = bus::Participant::create(service.bus()).value();
  auto sender = TelemetryPublisher<Pulse>::create(participant, "\x1b[2J\xff").value();
  ASSERT_TRUE(sender.wait_for_subscriber(30s));
  const Pulse pulse{.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::Sun1};
  ASSERT_TRUE(sender.publish("SPINNER", pulse, std::stop_token{}));
  ASSERT_TRUE(sender.publish("\x1b]0;x\x07", pulse, std::stop_token{}));
  ASSERT_TRUE(sender.wait_for_acknowledgments(30s));
  ASSERT_EQ(service.stop(), 0) << service.log();

  EXPECT_THAT(rows_of(service.db(), "SELECT source, received FROM source_count"),
              ElementsAre("\\x1b[2J\\xff|2|"));
  const auto rejected = rows_of(service.db(), "SELECT source, reason FROM rejected_input");
  ASSERT_EQ(rejected.size(), 2U);
  EXPECT_THAT(rejected[0] + rejected[1], HasSubstr("spacecraft = \"\\x1b]0;x\\x07\""));
  for (const std::string& text : {rejected[0], rejected[1], service.program().log()}) {
    EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
  }
}

}  // namespace spindrift::hostile_sender_test
