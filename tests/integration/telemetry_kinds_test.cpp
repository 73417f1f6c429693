#include <limits>
#include <string>
#include <vector>

#include "services/archive/archive.h"
#include "services/archive/stored_pass.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::telemetry_kinds_test {

const TaiTime kStart = tai_from_ns(1'772'337'697'000'000'000);

Pulse example(Kind<Pulse> /*kind*/) { return {.t = kStart, .channel = PulseChannel::SouthOut}; }
CodedFrame example(Kind<CodedFrame> /*kind*/) {
  return {.t = kStart, .period_s = 0.6, .delay_s = {std::nullopt, 0.1, {}, 0.7, {}, 1.2}};
}
GyroSample example(Kind<GyroSample> /*kind*/) {
  return {.t = kStart, .rate_body_rad_s = {0.1, -0.2, 0.3}};
}
StarFix example(Kind<StarFix> /*kind*/) {
  return {.t = kStart, .q_icrf_sensor = {0.5, -0.5, 0.5004, -0.5}};
}
SunDirection example(Kind<SunDirection> /*kind*/) {
  return {.t = kStart, .sun_body = {0.6, 0.0, -0.8}};
}
MagneticField example(Kind<MagneticField> /*kind*/) {
  return {.t = kStart, .field_body_nt = {21000.0, -1200.0, 0.5}};
}
TimedOrbitState example(Kind<TimedOrbitState> /*kind*/) {
  return {
      .t = kStart,
      .state = {.position_icrf_km = {7000.0, 1.0, -2.0}, .velocity_icrf_km_s = {0.1, 7.5, -0.1}}};
}

/// Returns the time and the members as text.
template <class Value>
std::vector<std::string> members_of(const Value& value) {
  std::vector<std::string> members{std::to_string(tai_ns(value.t))};
  for_each_column(value, [&members](std::string_view name, const auto& member) {
    members.push_back(std::string{name} + " " + ::testing::PrintToString(member));
  });
  return members;
}

TEST(TelemetryKinds, EachComesOverTheBusAsItWasSent) {
  const auto participant = bus::Participant::create(bus_of_its_own()).value();
  BoundedQueue<SampleBatch> queue{1000};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SAT"}).value();
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> kind) {
    SCOPED_TRACE(Telemetry<Value>::kName);
    auto publisher = TelemetryPublisher<Value>::create(participant, "station", 7).value();
    ASSERT_TRUE(publisher.publish("SAT", example(kind), std::stop_token{}));
    const auto batch = queue.take();
    ASSERT_TRUE(batch);
    const auto& samples = batch->samples.template of<Value>();
    ASSERT_EQ(samples.size(), 1U);
    EXPECT_EQ(samples[0].spacecraft, "SAT");
    EXPECT_EQ(samples[0].origin.session, 7U);
    EXPECT_EQ(members_of(samples[0].value), members_of(example(kind)));
    EXPECT_EQ(batch->counts.at("station").missing, 0U);
  });
  EXPECT_EQ(subscriber->status().value().by_source.at("station").received, TelemetryKinds::kSize);
}

TEST(TelemetryKinds, NumbersThatAreNoneAreRejectedWithTheirReason) {
  const auto participant = bus::Participant::create(bus_of_its_own()).value();
  BoundedQueue<SampleBatch> queue{1000};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SAT"}).value();
  auto publisher = TelemetryPublisher<GyroSample>::create(participant, "station", 7).value();
  GyroSample sample = example(Kind<GyroSample>{});
  sample.rate_body_rad_s.z() = std::numeric_limits<double>::infinity();
  ASSERT_TRUE(publisher.publish("SAT", sample, std::stop_token{}));
  const auto batch = queue.take();
  ASSERT_TRUE(batch);
  EXPECT_EQ(count_of(batch->samples), 0U);
  ASSERT_EQ(batch->rejected.size(), 1U);
  EXPECT_THAT(batch->rejected[0].reason, HasSubstr("wz_rad_s = 0.1, -0.2, inf"));
}

class StoredKinds : public testing::ArchiveFixture {};

TEST_F(StoredKinds, EachComesBackFromTheArchiveInTheOrderOfArrival) {
  ArchiveBatch batch = testing::start_of("run-1");
  batch.start->first_arrival = {100};
  batch.reach = {.first = kStart, .last = kStart};
  std::int64_t arrival = 100;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> kind) {
    for (const int later_ns : {1, 0, 0}) {
      ArrivedSample<Value> sample{.spacecraft = "SPINNER",
                                  .origin = {.source = "station", .session = 7, .seq = 41},
                                  .value = example(kind),
                                  .arrival = {arrival++}};
      sample.value.t += std::chrono::nanoseconds{later_ns};
      batch.samples.template of<Value>().push_back(std::move(sample));
    }
  });
  const RunStart start = *batch.start;
  store(batch);

  SenderNames senders{""};
  const auto passes = find_stored_passes(path(), "SPINNER", start, senders).value();
  ASSERT_EQ(passes.size(), 1U);
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> kind) {
    SCOPED_TRACE(Telemetry<Value>::kName);
    const auto& values = passes.front().values.template of<Value>();
    ASSERT_EQ(values.size(), 2U);
    EXPECT_EQ(values[0].value.t, kStart + std::chrono::nanoseconds{1});
    EXPECT_EQ(members_of(values[1].value), members_of(example(kind)));
    const auto& last = passes.front().last_origins.at(kTelemetryKind<Value>);
    ASSERT_EQ(last.size(), 1U);
    EXPECT_EQ(last[0].seq, 41U);
  });
}

}  // namespace spindrift::telemetry_kinds_test
