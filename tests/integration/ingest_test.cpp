#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <functional>

#include "services/ingest/from_idl.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"

namespace spindrift::ingest_test {

using namespace std::chrono_literals;
using bus::Participant;
using bus::Writer;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

enum class Consumer { Works, IsHeld };

/// A subscriber and somebody who empties its queue; when held, only after `release()`.
class Station {
 public:
  explicit Station(const bus::BusConfig& config, std::size_t capacity = 64,
                   Consumer consumer = Consumer::Works)
      : participant_{Participant::create(config).value()},
        queue_{capacity},
        subscriber_{TelemetrySubscriber::start(participant_, queue_, {"SPINNER"}).value()},
        consumer_{[this] { consume(); }} {
    if (consumer == Consumer::Works) {
      release();
    }
  }
  /// Releases the consumer and closes the queue first: whatever a test expected in vain, the
  /// subscriber that waits for room in the queue ends.
  ~Station() { finish(); }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  Station(Station&&) = delete;
  Station& operator=(Station&&) = delete;

  void release() {
    held_ = false;
    held_.notify_all();
  }

  Participant& participant() { return participant_; }
  TelemetrySubscriberStatus status() const { return subscriber_->status().value(); }

  SequenceCounts counts_of(const std::string& source) const {
    const auto by_source = status().by_source;
    const auto found = by_source.find(source);
    return found == by_source.end() ? SequenceCounts{} : found->second;
  }

  /// Everything that arrived, once the subscriber has stopped.
  SampleBatch finish() {
    release();
    subscriber_->stop();
    queue_.close();
    if (consumer_.joinable()) {
      consumer_.join();
    }
    return std::move(arrived_);
  }

 private:
  void consume() {
    held_.wait(true);
    while (auto batch = queue_.take()) {
      TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
        auto& some = batch->samples.of<Value>();
        std::move(some.begin(), some.end(), std::back_inserter(arrived_.samples.of<Value>()));
      });
      std::move(batch->rejected.begin(), batch->rejected.end(),
                std::back_inserter(arrived_.rejected));
      for (const auto& [spacecraft, samples] : batch->others) {
        arrived_.others[spacecraft] += samples;
      }
    }
  }

  Participant participant_;
  BoundedQueue<SampleBatch> queue_;
  std::unique_ptr<TelemetrySubscriber> subscriber_;
  SampleBatch arrived_;
  std::atomic<bool> held_{true};
  std::thread consumer_;
};

Writer<spindrift_Pulse> pulse_writer(const Participant& participant) {
  return Writer<spindrift_Pulse>::create(participant, bus::topic_of<Pulse>(),
                                         bus::telemetry_writer_qos())
      .value();
}

std::vector<std::uint64_t> seqs_of(const std::vector<TelemetrySample<Pulse>>& samples) {
  std::vector<std::uint64_t> seqs;
  seqs.reserve(samples.size());
  for (const TelemetrySample<Pulse>& sample : samples) {
    seqs.push_back(sample.origin.seq);
  }
  return seqs;
}

TEST(FromIdl, KeepsEveryField) {
  const TelemetrySample<Pulse> sample = from_idl<Pulse>(idl_pulse(41, 17)).value();
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "front-end");
  EXPECT_EQ(sample.origin.session, 17U);
  EXPECT_EQ(sample.origin.seq, 41U);
  EXPECT_EQ(tai_ns(sample.value.t), kTestTime_tai_ns + 41'000'000'000);
  EXPECT_EQ(sample.value.channel, PulseChannel::Sun1);
}

TEST(FromIdl, NamesTheChannelsAsTheIdlDoes) {
  const auto channel_of = [](spindrift_PulseChannel channel) {
    spindrift_Pulse pulse = idl_pulse(0);
    pulse.channel = channel;
    return name_of(from_idl<Pulse>(pulse).value().value.channel);
  };
  EXPECT_EQ(channel_of(spindrift_SUN1), "sun1");
  EXPECT_EQ(channel_of(spindrift_SUN2), "sun2");
  EXPECT_EQ(channel_of(spindrift_NORTH_IN), "north_in");
  EXPECT_EQ(channel_of(spindrift_NORTH_OUT), "north_out");
  EXPECT_EQ(channel_of(spindrift_SOUTH_IN), "south_in");
  EXPECT_EQ(channel_of(spindrift_SOUTH_OUT), "south_out");
}

struct Impossible {
  std::function<void(spindrift_Pulse&)> spoil;
  const char* reason;
};

TEST(FromIdl, RefusesWhatCannotBeTrueWithItsReason) {
  const std::vector<Impossible> cases = {
      {[](auto& pulse) { pulse.spacecraft[0] = '\0'; },
       "spacecraft = \"\": must be 1 to 32 printable ASCII characters"},
      {[](auto& pulse) { pulse.spacecraft[1] = '\n'; }, "spacecraft = \"S\\x0aINNER\": must be"},
      {[](auto& pulse) { pulse.source[0] = '\xFF'; },
       "source = \"\\xffront-end\": must be printable ASCII"},
      {[](auto& pulse) { pulse.t_tai_ns = 63'072'009'999'999'999; },
       "t_tai_ns = 63072009999999999: must lie in the years 1972 to 2099"},
      {[](auto& pulse) { pulse.t_tai_ns = 4'102'444'800'000'000'000; }, "must lie in the years"},
      {[](auto& pulse) { pulse.t_tai_ns = std::numeric_limits<std::int64_t>::min(); },
       "must lie in the years"},
      {[](auto& pulse) {
         const std::uint32_t unknown = 6;
         std::memcpy(&pulse.channel, &unknown, sizeof unknown);
       },
       "channel = 6: must be 0 to 5"},
      {[](auto& pulse) { std::memset(&pulse.channel, 0xFF, sizeof pulse.channel); },
       "channel = 4294967295: must be 0 to 5"}};
  for (const Impossible& impossible : cases) {
    SCOPED_TRACE(impossible.reason);
    spindrift_Pulse pulse = idl_pulse(0);
    impossible.spoil(pulse);
    const auto refused = from_idl<Pulse>(pulse);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidInput);
    EXPECT_THAT(refused.error().message, HasSubstr(impossible.reason));
  }
}

TEST(FromIdl, TakesTheFirstAndLastTimeOfTelemetry) {
  for (const std::int64_t t_tai_ns : {63'072'010'000'000'000, 4'102'444'799'999'999'999}) {
    spindrift_Pulse pulse = idl_pulse(0);
    pulse.t_tai_ns = t_tai_ns;
    EXPECT_EQ(tai_ns(from_idl<Pulse>(pulse).value().value.t), t_tai_ns);
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

spindrift_CodedFrame idl_frame(std::uint64_t seq) {
  return {.spacecraft = "SPINNER",
          .source = "front-end",
          .session = 1,
          .seq = seq,
          .t_tai_ns = kTestTime_tai_ns + static_cast<std::int64_t>(seq) * 1'000'000'000,
          .period_s = 1.0,
          .sun2_s = 0.125,
          .north_in_s = 0.25,
          .north_out_s = 0.375,
          .south_in_s = 0.5,
          .south_out_s = 0.625};
}

TEST(FromIdl, KeepsEveryFieldOfACodedFrame) {
  const TelemetrySample<CodedFrame> sample = from_idl<CodedFrame>(idl_frame(41)).value();
  EXPECT_EQ(sample.spacecraft, "SPINNER");
  EXPECT_EQ(sample.origin.source, "front-end");
  EXPECT_EQ(sample.origin.session, 1U);
  EXPECT_EQ(sample.origin.seq, 41U);
  EXPECT_EQ(tai_ns(sample.value.t), kTestTime_tai_ns + 41'000'000'000);
  EXPECT_EQ(sample.value.period_s, 1.0);
  EXPECT_THAT(sample.value.delay_s, ElementsAre(std::nullopt, 0.125, 0.25, 0.375, 0.5, 0.625));
}

TEST(FromIdl, TakesNanForNotReceived) {
  spindrift_CodedFrame frame = idl_frame(0);
  frame.period_s = frame.sun2_s = frame.north_in_s = kNan;
  frame.north_out_s = frame.south_in_s = frame.south_out_s = kNan;
  const TelemetrySample<CodedFrame> sample = from_idl<CodedFrame>(frame).value();
  EXPECT_EQ(sample.value.period_s, std::nullopt);
  EXPECT_THAT(sample.value.delay_s, ::testing::Each(std::nullopt));
}

struct ImpossibleFrame {
  std::function<void(spindrift_CodedFrame&)> spoil;
  const char* reason;
};

TEST(FromIdl, RefusesACodedFrameThatCannotBeTrueWithItsReason) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<ImpossibleFrame> cases = {
      {[](auto& frame) { frame.spacecraft[0] = ' '; }, "spacecraft = \" PINNER\": must be"},
      {[](auto& frame) { frame.t_tai_ns = -1; }, "t_tai_ns = -1: must lie in the years"},
      {[](auto& frame) { frame.period_s = 0.0; }, "period_s = 0: must be above 0, at most 60 s"},
      {[](auto& frame) { frame.period_s = kInfinity; }, "period_s = inf: must be above 0"},
      {[](auto& frame) { frame.sun2_s = -kInfinity; }, "sun2_s = -inf: must be 0 to two periods"},
      {[](auto& frame) { frame.south_out_s = 2.01; },
       "south_out_s = 2.01: must be 0 to two periods, 2 s"}};
  for (const ImpossibleFrame& impossible : cases) {
    SCOPED_TRACE(impossible.reason);
    spindrift_CodedFrame frame = idl_frame(0);
    impossible.spoil(frame);
    const auto refused = from_idl<CodedFrame>(frame);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidInput);
    EXPECT_THAT(refused.error().message, HasSubstr(impossible.reason));
  }
}

TEST(TelemetrySubscriber, TakesCodedFramesBesidePulsesAndCountsBothOfASource) {
  Station station{bus_of_its_own()};
  const auto session = random_session();
  auto pulses =
      TelemetryPublisher<Pulse>::create(station.participant(), "antenna", session).value();
  auto frames =
      TelemetryPublisher<CodedFrame>::create(station.participant(), "antenna", session).value();
  const std::stop_token never;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) {
    const TaiTime t = tai_from_ns(kTestTime_tai_ns + i);
    ASSERT_TRUE(pulses.publish("SPINNER", {.t = t, .channel = PulseChannel::Sun1}, never));
    ASSERT_TRUE(frames.publish("SPINNER",
                               {.t = t, .period_s = 0.5, .delay_s = {std::nullopt, 0.25}}, never));
  }
  ASSERT_TRUE(eventually([&] { return station.counts_of("antenna").received == 2 * kCount; }));
  // Both topics count from 0 in one session: neither gaps nor duplicates.
  EXPECT_EQ(station.counts_of("antenna"), (SequenceCounts{.received = 2 * kCount}));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(arrived.samples.of<Pulse>().size(), kCount);
  ASSERT_EQ(arrived.samples.of<CodedFrame>().size(), kCount);
  EXPECT_EQ(arrived.samples.of<CodedFrame>().back().origin.session, session);
  EXPECT_EQ(arrived.samples.of<CodedFrame>().back().origin.seq, kCount - 1);
  EXPECT_EQ(tai_ns(arrived.samples.of<CodedFrame>().back().value.t), kTestTime_tai_ns + kCount - 1);
  EXPECT_EQ(arrived.samples.of<CodedFrame>().back().value.period_s, 0.5);
  EXPECT_THAT(
      arrived.samples.of<CodedFrame>().back().value.delay_s,
      ElementsAre(std::nullopt, 0.25, std::nullopt, std::nullopt, std::nullopt, std::nullopt));
}

TEST(TelemetrySubscriber, PassesOnACodedFrameThatCannotBeTrueAsRejected) {
  Station station{bus_of_its_own()};
  const auto writer =
      Writer<spindrift_CodedFrame>::create(station.participant(), bus::topic_of<CodedFrame>(),
                                           bus::telemetry_writer_qos())
          .value();
  spindrift_CodedFrame impossible = idl_frame(7);
  impossible.north_in_s = 2.5;
  ASSERT_TRUE(writer.write(impossible));
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == 1; }));
  const SampleBatch arrived = station.finish();
  EXPECT_TRUE(arrived.samples.of<CodedFrame>().empty());
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].line, 7);
  EXPECT_EQ(arrived.rejected[0].session, 1U);
  EXPECT_THAT(arrived.rejected[0].reason, HasSubstr("north_in_s = 2.5"));
}

TEST(TelemetrySubscriber, QueuesWhatAPublisherSends) {
  Station station{bus_of_its_own()};
  auto publisher = TelemetryPublisher<Pulse>::create(station.participant(), "antenna").value();
  const auto session = publisher.next().session;
  const Pulse pulse{.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::NorthOut};
  ASSERT_TRUE(publisher.publish("SPINNER", pulse, {}));
  ASSERT_TRUE(eventually([&] { return station.counts_of("antenna").received == 1; }));
  const SampleBatch arrived = station.finish();
  ASSERT_EQ(arrived.samples.of<Pulse>().size(), 1U);
  EXPECT_EQ(arrived.samples.of<Pulse>()[0].spacecraft, "SPINNER");
  EXPECT_EQ(arrived.samples.of<Pulse>()[0].origin.source, "antenna");
  EXPECT_EQ(arrived.samples.of<Pulse>()[0].origin.session, session);
  EXPECT_EQ(arrived.samples.of<Pulse>()[0].origin.seq, 0U);
  EXPECT_EQ(arrived.samples.of<Pulse>()[0].value, pulse);
}

TEST(TelemetrySubscriber, TakesWhatWasSentBeforeItCameInTheOrderOfItsWriting) {
  const auto config = bus_of_its_own();
  const auto front_end = Participant::create(config).value();
  auto gyro = TelemetryPublisher<GyroSample>::create(front_end, "station", 7).value();
  auto star = TelemetryPublisher<StarFix>::create(front_end, "station", 7).value();
  for (int second = 0; second < 600; ++second) {
    const TaiTime t = tai_from_ns(kTestTime_tai_ns) + std::chrono::seconds{second};
    ASSERT_TRUE(second % 10 > 0 ? gyro.publish("SPINNER", GyroSample{.t = t}, {})
                                : star.publish("SPINNER", StarFix{.t = t}, {}));
  }
  BoundedQueue<SampleBatch> queue{64};
  const auto participant = Participant::create(config).value();
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value();
  std::vector<TaiTime> times;
  while (times.size() < 600) {
    const auto batch = queue.take();
    in_order_of_arrival(batch->samples,
                        [&](const auto& sample) { times.push_back(sample.value.t); });
  }
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST(TelemetrySubscriber, LosesNothingToASlowConsumer) {
  constexpr std::size_t kCount = 80'000;
  const auto config = bus_of_its_own();
  Station station{config, 2, Consumer::IsHeld};
  ForeignWriter writer{config, "telemetry", kCount};
  // Queue and reader are full before the first pulse is consumed.
  ASSERT_TRUE(eventually([&] { return station.status().reader.rejected > 0; }));
  station.release();
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == kCount; }));
  EXPECT_EQ(writer.exit_status(), 0);
  EXPECT_EQ(station.counts_of("front-end"), (SequenceCounts{.received = kCount}));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(seqs_of(arrived.samples.of<Pulse>()), first_seqs(kCount));
}

TEST(TelemetrySubscriber, PassesOnWhatCannotBeTrueAsRejected) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  spindrift_Pulse impossible = idl_pulse(1);
  impossible.t_tai_ns = -1;
  ASSERT_TRUE(writer.write(idl_pulse(0)));
  ASSERT_TRUE(writer.write(impossible));
  ASSERT_TRUE(writer.write(idl_pulse(2)));
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == 3; }));
  EXPECT_EQ(station.counts_of("front-end").missing, 0U);
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(arrived.samples.of<Pulse>().size(), 2U);
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].source, "front-end");
  EXPECT_EQ(arrived.rejected[0].line, 1);
  EXPECT_THAT(arrived.rejected[0].reason, HasSubstr("t_tai_ns = -1"));
}

TEST(TelemetrySubscriber, CountsWhatCannotBeTrueOfItsSpacecraftOnly) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  for (std::uint64_t seq = 0; seq < 6; ++seq) {
    spindrift_Pulse pulse = idl_pulse(seq);
    if (seq < 3) {
      std::string_view{"OTHER\0", 6}.copy(pulse.spacecraft, sizeof pulse.spacecraft);
    }
    pulse.t_tai_ns = seq % 3 == 0 ? -1 : pulse.t_tai_ns;
    ASSERT_TRUE(writer.write(pulse));
  }
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == 6; }));
  const auto counts = station.status().by_spacecraft;
  ASSERT_EQ(counts.size(), 1U);
  EXPECT_EQ(counts.at("SPINNER").received, 3U);
  EXPECT_EQ(counts.at("SPINNER").rejected, 1U);
  EXPECT_EQ(station.finish().rejected.size(), 2U);
}

TEST(TelemetrySubscriber, CountsGapsDuplicatesAndDisorderAndPassesAllOn) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  for (const std::uint64_t seq : {0U, 4U, 1U, 1U}) {
    ASSERT_TRUE(writer.write(idl_pulse(seq)));
  }
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == 4; }));
  EXPECT_EQ(station.counts_of("front-end"),
            (SequenceCounts{.received = 4, .missing = 2, .duplicates = 1, .disordered = 1}));
  EXPECT_EQ(station.finish().samples.of<Pulse>().size(), 4U);
}

/// A source that starts, sends `count` pulses and ends.
Expected<void> run_source(const Participant& participant, int count) {
  auto publisher = TelemetryPublisher<Pulse>::create(participant, "antenna").value();
  Expected<void> sent = publisher.wait_for_subscriber(30s);
  for (int i = 0; i < count && sent; ++i) {
    sent = publisher.publish(
        "SPINNER", {.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::Sun1}, {});
  }
  return sent.and_then([&publisher] { return publisher.wait_for_acknowledgments(30s); });
}

TEST(TelemetrySubscriber, CountsNoGapWhenASourceRestarts) {
  Station station{bus_of_its_own()};
  ASSERT_TRUE(run_source(station.participant(), 5));
  ASSERT_TRUE(eventually([&] { return station.counts_of("antenna").received == 5; }));
  ASSERT_TRUE(run_source(station.participant(), 10));
  ASSERT_TRUE(eventually([&] { return station.counts_of("antenna").received == 15; }));
  EXPECT_EQ(station.counts_of("antenna"), (SequenceCounts{.received = 15}));
}

TEST(TelemetrySubscriber, CatchesUpOnWhatWasSentBeforeItStarted) {
  const auto config = bus_of_its_own();
  const auto participant = Participant::create(config).value();
  const auto writer = pulse_writer(participant);
  for (std::uint64_t seq = 0; seq < 1000; ++seq) {
    ASSERT_TRUE(writer.write(idl_pulse(seq)));
  }
  Station station{config};
  EXPECT_TRUE(eventually(
      [&] { return station.counts_of("front-end") == SequenceCounts{.received = 1000}; }));
}

TEST(TelemetrySubscriber, NamesAnIncompatibleWriterWhileItIsThere) {
  const auto config = bus_of_its_own();
  Station station{config};
  EXPECT_THAT(station.status().reader.incompatible_writers, ElementsAre());
  ForeignWriter writer{config, "weak", 0};
  ASSERT_TRUE(eventually([&] { return !station.status().reader.incompatible_writers.empty(); }));
  EXPECT_THAT(station.status().reader.incompatible_writers,
              ElementsAre(HasSubstr("pid " + std::to_string(writer.pid()))));
}

TEST(TelemetrySubscriber, StopsWhilePulsesArriveAndKeepsWhatItTook) {
  Station station{bus_of_its_own(), 2};
  std::jthread front_end{[&station](const std::stop_token& stop) {
    auto publisher = TelemetryPublisher<Pulse>::create(station.participant(), "antenna").value();
    Expected<void> published;
    while (published && !stop.stop_requested()) {
      published = publisher.publish(
          "SPINNER", {.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::Sun1}, stop);
    }
  }};
  ASSERT_TRUE(eventually([&] { return station.counts_of("antenna").received > 1000; }));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(arrived.samples.of<Pulse>().size(), station.counts_of("antenna").received);
  EXPECT_FALSE(station.status().taking);
  EXPECT_EQ(station.status().failure, "");
}

TEST(TelemetrySubscriber, HandsOverWhatIsAcknowledgedWhenStopped) {
  // The queue is full at once, and the rest waits in the reader, acknowledged.
  Station station{bus_of_its_own(), 1, Consumer::IsHeld};
  constexpr std::uint64_t kSent = 3000;
  const auto writer = pulse_writer(station.participant());
  for (std::uint64_t seq = 0; seq < kSent; ++seq) {
    ASSERT_TRUE(writer.write(idl_pulse(seq), std::stop_token{}));
  }
  ASSERT_TRUE(writer.wait_for_acknowledgments(std::chrono::seconds{30}));
  EXPECT_EQ(station.finish().samples.of<Pulse>().size(), kSent);
}

TEST(TelemetrySubscriber, SaysSoWhenItsQueueIsClosedTooEarly) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  BoundedQueue<SampleBatch> queue{4};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value();
  queue.close();
  ASSERT_TRUE(pulse_writer(participant).write(idl_pulse(0)));
  ASSERT_TRUE(eventually([&] { return !subscriber->status().value().taking; }));
  EXPECT_THAT(subscriber->status().value().failure, HasSubstr("closed while they arrive"));
  EXPECT_EQ(subscriber->status().value().discarded, 1U);
}

TEST(TelemetrySubscriber, CountsSamplesOfOtherSpacecraftAndDoesNotHandThemOver) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  spindrift_Pulse other = idl_pulse(1);
  other.spacecraft[0] = 'X';
  spindrift_Pulse impossible = idl_pulse(2);
  impossible.spacecraft[0] = ' ';
  ASSERT_TRUE(writer.write(idl_pulse(0)));
  ASSERT_TRUE(writer.write(other));
  ASSERT_TRUE(writer.write(impossible));
  ASSERT_TRUE(writer.write(idl_pulse(3)));
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == 4; }));
  EXPECT_EQ(station.counts_of("front-end"), (SequenceCounts{.received = 4}));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(seqs_of(arrived.samples.of<Pulse>()), (std::vector<std::uint64_t>{0, 3}));
  EXPECT_EQ(arrived.others, (OtherSpacecraft{{"XPINNER", 1}}));
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].line, 2);
}

TEST(TelemetrySubscriber, HandsOverCountsOfOtherSpacecraftThoughNothingElseArrives) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  BoundedQueue<SampleBatch> queue{4};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value();
  spindrift_Pulse other = idl_pulse(0);
  other.spacecraft[0] = 'X';
  ASSERT_TRUE(pulse_writer(participant).write(other));
  const auto batch = queue.take();
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->others, (OtherSpacecraft{{"XPINNER", 1}}));
  EXPECT_EQ(batch->counts.at("front-end"), (SequenceCounts{.received = 1}));
}

TEST(TelemetrySubscriber, CountsASourceThatCannotBeShownAsItIsShown) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  spindrift_Pulse pulse = idl_pulse(0);
  pulse.source[0] = '\x1b';
  pulse.source[1] = '\xff';
  ASSERT_TRUE(writer.write(pulse));
  ASSERT_TRUE(eventually([&] { return station.counts_of("\\x1b\\xffont-end").received == 1; }));
  const SampleBatch arrived = station.finish();
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].source, "\\x1b\\xffont-end");
}

TEST(TelemetrySubscriber, KeepsFewOfManyImpossibleSamplesAndTheNumberOfTheRest) {
  Station station{bus_of_its_own()};
  const auto writer = pulse_writer(station.participant());
  constexpr std::int64_t kSent = 2000;
  for (std::uint64_t seq = 0; seq < kSent; ++seq) {
    spindrift_Pulse pulse = idl_pulse(seq);
    pulse.t_tai_ns = -1;
    ASSERT_TRUE(writer.write(pulse, std::stop_token{}));
  }
  ASSERT_TRUE(eventually([&] { return station.counts_of("front-end").received == kSent; }));
  const SampleBatch arrived = station.finish();
  std::int64_t samples = 0;
  for (const RejectedInput& rejected : arrived.rejected) {
    samples += rejected.samples;
  }
  EXPECT_EQ(samples, kSent);
  // Of two minutes at most, on the slowest of machines.
  EXPECT_LE(arrived.rejected.size(), 2 * (RejectionLimit::kKept + 1));
}

TEST(TelemetrySubscriber, SaysSoWhenAnExceptionEndsItsTaking) {
  const auto participant = Participant::create(bus_of_its_own()).value();
  BoundedQueue<SampleBatch> queue{
      4, [](const SampleBatch& /*batch*/) -> std::size_t { throw std::bad_alloc{}; }};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value();
  ASSERT_TRUE(pulse_writer(participant).write(idl_pulse(0)));
  ASSERT_TRUE(eventually([&] { return !subscriber->status().value().taking; }));
  EXPECT_EQ(subscriber->status().value().failure, "taking samples: out of memory");
}

// Deleting a full reader waits for Cyclone's receive thread, which waits for room in it.
TEST(TelemetrySubscriber, StopsAndCountsWhatNobodyTookWhileItsReaderIsFull) {
  const auto config = bus_of_its_own();
  const auto participant = Participant::create(config).value();
  BoundedQueue<SampleBatch> queue{1};
  const auto subscriber = TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value();
  const ForeignWriter writer{config, "telemetry", 1'000'000'000};
  ASSERT_TRUE(eventually([&] { return subscriber->status().value().reader.rejected > 0; }));
  queue.close();
  subscriber->stop();
  EXPECT_GE(subscriber->status().value().discarded,
            static_cast<std::uint64_t>(bus::kTelemetryReaderSamples));
  EXPECT_GT(subscriber->status().value().reader.rejected, 0U);
}

}  // namespace spindrift::ingest_test
