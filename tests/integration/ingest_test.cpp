#include <atomic>

#include "services/ingest/telemetry_subscriber.h"
#include "services/publisher/telemetry_publisher.h"
#include "tests/support/bus_child.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::ingest_test {

using namespace std::chrono_literals;
using bus::Participant;

enum class Consumer { Works, IsHeld };

/// Runs a subscriber and a consumer of its queue; a held consumer starts at `release()`.
class Station {
 public:
  explicit Station(const bus::BusConfig& config = bus_of_its_own(), std::size_t capacity = 64,
                   Consumer consumer = Consumer::Works)
      : participant_{Participant::create(config).value()},
        queue_{capacity},
        subscriber_{TelemetrySubscriber::start(participant_, queue_, {"SPINNER"}).value()},
        consumer_{[this] { consume(); }} {
    if (consumer == Consumer::Works) {
      release();
    }
  }
  /// Releases the consumer and closes the queue, so that a subscriber that waits for room in the
  /// queue ends even after a failed test.
  ~Station() { finish(); }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

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

  /// Waits until so many samples of a source were received.
  bool receives(std::uint64_t samples, const std::string& source = "front-end") const {
    return eventually([&] { return counts_of(source).received == samples; });
  }

  /// Returns everything that arrived after stopping the subscriber.
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

/// A station and a writer that sends it messages as they are.
struct WrittenStation : Station {
  bus::Writer<spindrift_Pulse> writer = telemetry_writer<Pulse>(participant());
  bool writes(const std::vector<spindrift_Pulse>& pulses) const {
    return std::all_of(pulses.begin(), pulses.end(), [this](const spindrift_Pulse& pulse) {
      return writer.write(pulse, std::stop_token{}).has_value();
    });
  }
};

/// A subscriber whose queue only the test takes from.
struct Unattended {
  explicit Unattended(BoundedQueue<SampleBatch>& queue,
                      const bus::BusConfig& bus = bus_of_its_own())
      : participant{Participant::create(bus).value()},
        subscriber{TelemetrySubscriber::start(participant, queue, {"SPINNER"}).value()} {}

  TelemetrySubscriberStatus status() const { return subscriber->status().value(); }

  Participant participant;
  std::unique_ptr<TelemetrySubscriber> subscriber;
};

std::vector<std::uint64_t> seqs_of(const std::vector<TelemetrySample<Pulse>>& samples) {
  std::vector<std::uint64_t> seqs;
  seqs.reserve(samples.size());
  for (const TelemetrySample<Pulse>& sample : samples) {
    seqs.push_back(sample.origin.seq);
  }
  return seqs;
}

TEST(TelemetrySubscriber, TakesCodedFramesBesidePulsesAndCountsBothOfASource) {
  Station station;
  const auto session = random_session();
  auto pulses =
      TelemetryPublisher<Pulse>::create(station.participant(), "antenna", session).value();
  auto frames =
      TelemetryPublisher<CodedFrame>::create(station.participant(), "antenna", session).value();
  const std::stop_token never;
  constexpr int kCount = 1000;
  for (int i = 0; i < kCount; ++i) {
    const TaiTime t = tai_from_ns(kTestTime_tai_ns + i);
    ASSERT_TRUE(pulses.publish("SPINNER", {.t = t, .channel = PulseChannel::NorthOut}, never));
    ASSERT_TRUE(frames.publish("SPINNER",
                               {.t = t, .period_s = 0.5, .delay_s = {std::nullopt, 0.25}}, never));
  }
  ASSERT_TRUE(station.receives(2 * kCount, "antenna"));
  // Both topics count from 0 in one session, which is neither a gap nor a duplicate.
  EXPECT_EQ(station.counts_of("antenna"), (SequenceCounts{.received = 2 * kCount}));
  const SampleBatch arrived = station.finish();
  ASSERT_EQ(arrived.samples.of<Pulse>().size(), kCount);
  const TelemetrySample<Pulse>& first = arrived.samples.of<Pulse>().front();
  EXPECT_EQ(first.spacecraft, "SPINNER");
  EXPECT_EQ(first.origin.source, "antenna");
  EXPECT_EQ(first.origin.session, session);
  EXPECT_EQ(first.origin.seq, 0U);
  EXPECT_EQ(first.value,
            (Pulse{.t = tai_from_ns(kTestTime_tai_ns), .channel = PulseChannel::NorthOut}));
  ASSERT_EQ(arrived.samples.of<CodedFrame>().size(), kCount);
  const TelemetrySample<CodedFrame>& last = arrived.samples.of<CodedFrame>().back();
  EXPECT_EQ(last.origin.session, session);
  EXPECT_EQ(last.origin.seq, kCount - 1);
  EXPECT_EQ(tai_ns(last.value.t), kTestTime_tai_ns + kCount - 1);
  EXPECT_EQ(last.value.period_s, 0.5);
  EXPECT_THAT(last.value.delay_s, ElementsAre(std::nullopt, 0.25, std::nullopt, std::nullopt,
                                              std::nullopt, std::nullopt));
}

TEST(TelemetrySubscriber, PassesOnACodedFrameThatCannotBeTrueAsRejected) {
  Station station;
  spindrift_CodedFrame impossible = idl_frame(7);
  impossible.north_in_s = 2.5;
  ASSERT_TRUE(telemetry_writer<CodedFrame>(station.participant()).write(impossible));
  ASSERT_TRUE(station.receives(1));
  const SampleBatch arrived = station.finish();
  EXPECT_TRUE(arrived.samples.of<CodedFrame>().empty());
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].line, 7);
  EXPECT_EQ(arrived.rejected[0].session, 1U);
  EXPECT_THAT(arrived.rejected[0].reason, HasSubstr("north_in_s = 2.5"));
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
  const Unattended unattended{queue, config};
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
  // Queue and reader must be full before the first pulse is consumed.
  ASSERT_TRUE(eventually([&] { return station.status().reader.rejected > 0; }));
  station.release();
  ASSERT_TRUE(station.receives(kCount));
  EXPECT_EQ(writer.exit_status(), 0);
  EXPECT_EQ(station.counts_of("front-end"), (SequenceCounts{.received = kCount}));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(seqs_of(arrived.samples.of<Pulse>()), first_seqs(kCount));
}

TEST(TelemetrySubscriber, PassesOnWhatCannotBeTrueAsRejected) {
  WrittenStation station;
  spindrift_Pulse impossible = idl_pulse(1);
  impossible.t_tai_ns = -1;
  ASSERT_TRUE(station.writes({idl_pulse(0), impossible, idl_pulse(2)}));
  ASSERT_TRUE(station.receives(3));
  EXPECT_EQ(station.counts_of("front-end").missing, 0U);
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(arrived.samples.of<Pulse>().size(), 2U);
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].source, "front-end");
  EXPECT_EQ(arrived.rejected[0].line, 1);
  EXPECT_THAT(arrived.rejected[0].reason, HasSubstr("t_tai_ns = -1"));
}

TEST(TelemetrySubscriber, CountsWhatCannotBeTrueOfItsSpacecraftOnly) {
  WrittenStation station;
  for (std::uint64_t seq = 0; seq < 6; ++seq) {
    spindrift_Pulse pulse = idl_pulse(seq);
    if (seq < 3) {
      std::string_view{"OTHER\0", 6}.copy(pulse.spacecraft, sizeof pulse.spacecraft);
    }
    pulse.t_tai_ns = seq % 3 == 0 ? -1 : pulse.t_tai_ns;
    ASSERT_TRUE(station.writes({pulse}));
  }
  ASSERT_TRUE(station.receives(6));
  const auto counts = station.status().by_spacecraft;
  ASSERT_EQ(counts.size(), 1U);
  EXPECT_EQ(counts.at("SPINNER").received, 3U);
  EXPECT_EQ(counts.at("SPINNER").rejected, 1U);
  EXPECT_EQ(station.finish().rejected.size(), 2U);
}

TEST(TelemetrySubscriber, CountsGapsDuplicatesAndDisorderAndPassesAllOn) {
  WrittenStation station;
  ASSERT_TRUE(station.writes({idl_pulse(0), idl_pulse(4), idl_pulse(1), idl_pulse(1)}));
  ASSERT_TRUE(station.receives(4));
  EXPECT_EQ(station.counts_of("front-end"),
            (SequenceCounts{.received = 4, .missing = 2, .duplicates = 1, .disordered = 1}));
  EXPECT_EQ(station.finish().samples.of<Pulse>().size(), 4U);
}

/// Runs a source that starts, sends `count` pulses and ends.
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
  Station station;
  ASSERT_TRUE(run_source(station.participant(), 5));
  ASSERT_TRUE(station.receives(5, "antenna"));
  ASSERT_TRUE(run_source(station.participant(), 10));
  ASSERT_TRUE(station.receives(15, "antenna"));
  EXPECT_EQ(station.counts_of("antenna"), (SequenceCounts{.received = 15}));
}

TEST(TelemetrySubscriber, CatchesUpOnWhatWasSentBeforeItStarted) {
  const auto config = bus_of_its_own();
  const auto participant = Participant::create(config).value();
  const auto writer = telemetry_writer<Pulse>(participant);
  ASSERT_TRUE(write_pulses(writer, 1000));
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
  // The queue is full at once; the acknowledged rest waits in the reader.
  Station station{bus_of_its_own(), 1, Consumer::IsHeld};
  constexpr std::uint64_t kSent = 3000;
  const auto writer = telemetry_writer<Pulse>(station.participant());
  ASSERT_TRUE(write_pulses(writer, kSent));
  ASSERT_TRUE(writer.wait_for_acknowledgments(std::chrono::seconds{30}));
  EXPECT_EQ(station.finish().samples.of<Pulse>().size(), kSent);
}

TEST(TelemetrySubscriber, SaysSoWhenItsQueueIsClosedTooEarly) {
  BoundedQueue<SampleBatch> queue{4};
  const Unattended unattended{queue};
  queue.close();
  ASSERT_TRUE(telemetry_writer<Pulse>(unattended.participant).write(idl_pulse(0)));
  ASSERT_TRUE(eventually([&] { return !unattended.status().taking; }));
  EXPECT_THAT(unattended.status().failure, HasSubstr("closed while they arrive"));
  EXPECT_EQ(unattended.status().discarded, 1U);
}

TEST(TelemetrySubscriber, CountsSamplesOfOtherSpacecraftAndDoesNotHandThemOver) {
  WrittenStation station;
  spindrift_Pulse other = idl_pulse(1);
  other.spacecraft[0] = 'X';
  spindrift_Pulse impossible = idl_pulse(2);
  impossible.spacecraft[0] = ' ';
  ASSERT_TRUE(station.writes({idl_pulse(0), other, impossible, idl_pulse(3)}));
  ASSERT_TRUE(station.receives(4));
  EXPECT_EQ(station.counts_of("front-end"), (SequenceCounts{.received = 4}));
  const SampleBatch arrived = station.finish();
  EXPECT_EQ(seqs_of(arrived.samples.of<Pulse>()), (std::vector<std::uint64_t>{0, 3}));
  EXPECT_EQ(arrived.others, (OtherSpacecraft{{"XPINNER", 1}}));
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].line, 2);
}

TEST(TelemetrySubscriber, HandsOverCountsOfOtherSpacecraftThoughNothingElseArrives) {
  BoundedQueue<SampleBatch> queue{4};
  const Unattended unattended{queue};
  spindrift_Pulse other = idl_pulse(0);
  other.spacecraft[0] = 'X';
  ASSERT_TRUE(telemetry_writer<Pulse>(unattended.participant).write(other));
  const auto batch = queue.take();
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->others, (OtherSpacecraft{{"XPINNER", 1}}));
  EXPECT_EQ(batch->counts.at("front-end"), (SequenceCounts{.received = 1}));
}

TEST(TelemetrySubscriber, CountsASourceThatCannotBeShownAsItIsShown) {
  WrittenStation station;
  spindrift_Pulse pulse = idl_pulse(0);
  pulse.source[0] = '\x1b';
  pulse.source[1] = '\xff';
  ASSERT_TRUE(station.writes({pulse}));
  ASSERT_TRUE(station.receives(1, "\\x1b\\xffont-end"));
  const SampleBatch arrived = station.finish();
  ASSERT_EQ(arrived.rejected.size(), 1U);
  EXPECT_EQ(arrived.rejected[0].source, "\\x1b\\xffont-end");
}

TEST(TelemetrySubscriber, KeepsFewOfManyImpossibleSamplesAndTheNumberOfTheRest) {
  WrittenStation station;
  constexpr std::int64_t kSent = 2000;
  for (std::uint64_t seq = 0; seq < kSent; ++seq) {
    spindrift_Pulse pulse = idl_pulse(seq);
    pulse.t_tai_ns = -1;
    ASSERT_TRUE(station.writes({pulse}));
  }
  ASSERT_TRUE(station.receives(kSent));
  const SampleBatch arrived = station.finish();
  std::int64_t samples = 0;
  for (const RejectedInput& rejected : arrived.rejected) {
    samples += rejected.samples;
  }
  EXPECT_EQ(samples, kSent);
  // On a slow machine the rejections span at most two minutes of the limit.
  EXPECT_LE(arrived.rejected.size(), 2 * (RejectionLimit::kKept + 1));
}

TEST(TelemetrySubscriber, SaysSoWhenAnExceptionEndsItsTaking) {
  BoundedQueue<SampleBatch> queue{
      4, [](const SampleBatch& /*batch*/) -> std::size_t { throw std::bad_alloc{}; }};
  const Unattended unattended{queue};
  ASSERT_TRUE(telemetry_writer<Pulse>(unattended.participant).write(idl_pulse(0)));
  ASSERT_TRUE(eventually([&] { return !unattended.status().taking; }));
  EXPECT_EQ(unattended.status().failure, "taking samples: out of memory");
}

// Deleting a full reader would block: Cyclone's receive thread waits for room in it.
TEST(TelemetrySubscriber, StopsAndCountsWhatNobodyTookWhileItsReaderIsFull) {
  const auto config = bus_of_its_own();
  BoundedQueue<SampleBatch> queue{1};
  const Unattended unattended{queue, config};
  const ForeignWriter writer{config, "telemetry", 1'000'000'000};
  ASSERT_TRUE(eventually([&] { return unattended.status().reader.rejected > 0; }));
  queue.close();
  unattended.subscriber->stop();
  EXPECT_GE(unattended.status().discarded,
            static_cast<std::uint64_t>(bus::kTelemetryReaderSamples));
  EXPECT_GT(unattended.status().reader.rejected, 0U);
}

}  // namespace spindrift::ingest_test
