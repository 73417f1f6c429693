#include "services/telemetry/by_kind.h"

#include <set>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::by_kind_test {

TEST(TelemetryKinds, NoTwoShareATopicATableOrANameInMessages) {
  std::set<std::string_view> topics;
  std::set<std::string_view> tables;
  std::set<std::string_view> names;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    EXPECT_TRUE(topics.insert(Telemetry<Value>::kTopic).second);
    EXPECT_TRUE(tables.insert(Telemetry<Value>::kTable).second);
    EXPECT_TRUE(names.insert(Telemetry<Value>::kName).second);
  });
}

TEST(ByKind, GivesAllKindsInTheOrderOfArrival) {
  TelemetryValues values;
  values.of<Pulse>() = {{.arrival = {1}, .value = {}}, {.arrival = {2}, .value = {}}};
  values.of<GyroSample>() = {{.arrival = {0}, .value = {}}, {.arrival = {4}, .value = {}}};
  values.of<CodedFrame>() = {{.arrival = {3}, .value = {}}};
  EXPECT_EQ(count_of(values), 5U);
  std::vector<std::string> seen;
  in_order_of_arrival(values, [&seen]<class Value>(const Arrived<Value>& arrived) {
    seen.push_back(std::string{Telemetry<Value>::kName} + std::to_string(arrived.arrival.number));
  });
  EXPECT_THAT(seen, ElementsAre("gyro0", "pulses1", "pulses2", "coded3", "gyro4"));
}

TEST(ByKind, KeepsTheOrderOfAKindWithoutNumbers) {
  TelemetrySamples samples;
  for (std::uint64_t seq = 0; seq < 4; ++seq) {
    samples.of<StarFix>().push_back(
        {.spacecraft = "S", .origin = {.source = "s", .session = 0, .seq = seq}, .value = {}});
  }
  std::vector<std::uint64_t> seqs;
  in_order_of_arrival(samples, [&](const auto& sample) { seqs.push_back(sample.origin.seq); });
  EXPECT_THAT(seqs, ElementsAre(0, 1, 2, 3));
}

TEST(TelemetryOrder, TellsSamplesOfOneTimeApartByKindAndChannel) {
  const TaiTime t = tai_from_ns(5);
  const auto sun1 = order_of(Pulse{.t = t, .channel = PulseChannel::Sun1});
  const auto sun2 = order_of(Pulse{.t = t, .channel = PulseChannel::Sun2});
  CodedFrame frame{};
  frame.t = t;
  EXPECT_LT(sun1, sun2);
  EXPECT_LT(sun2, order_of(frame));
  EXPECT_EQ(order_of(StarFix{.t = t}), order_of(StarFix{.t = t, .q_icrf_sensor = {0, 1, 0, 0}}));
}

}  // namespace spindrift::by_kind_test
