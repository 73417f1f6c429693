#include "services/ingest/telemetry_subscriber.h"

#include <utility>

#include "services/ingest/from_idl.h"

namespace spindrift {
namespace {

// So many does Reader::take give at a time while there are more.
constexpr std::int32_t kTakenAtOnce = 256;

template <class Sample>
Expected<bus::Reader<Sample>> attached_reader(const bus::Participant& participant,
                                              const bus::Topic<Sample>& topic,
                                              bus::WaitSet& waitset) {
  auto reader = bus::Reader<Sample>::create(participant, topic, bus::telemetry_reader_qos());
  if (reader) {
    if (const auto attached = waitset.attach(reader->data()); !attached) {
      return Unexpected{attached.error()};
    }
  }
  return reader;
}

bool is_empty(const SampleBatch& batch) {
  return batch.pulses.empty() && batch.coded.empty() && batch.rejected.empty();
}

/// Of all readers together.
template <class... Readers>
Expected<bus::ReaderStatus> status_of(const Readers&... readers) {
  bus::ReaderStatus all{};
  for (auto& status : {readers.status()...}) {
    if (!status) {
      return status;
    }
    all += *status;
  }
  return all;
}

void keep(PulseSample&& sample, SampleBatch& batch) { batch.pulses.push_back(std::move(sample)); }
void keep(CodedSample&& sample, SampleBatch& batch) { batch.coded.push_back(std::move(sample)); }

}  // namespace

Expected<std::unique_ptr<TelemetrySubscriber>> TelemetrySubscriber::start(
    const bus::Participant& participant, BoundedQueue<SampleBatch>& queue,
    const LastOrigins& stored) {
  auto waitset = bus::WaitSet::create(participant);
  if (!waitset) {
    return Unexpected{waitset.error()};
  }
  auto pulses = attached_reader(participant, bus::kPulseTopic, *waitset);
  if (!pulses) {
    return Unexpected{pulses.error()};
  }
  auto coded = attached_reader(participant, bus::kCodedFrameTopic, *waitset);
  if (!coded) {
    return Unexpected{coded.error()};
  }
  return std::unique_ptr<TelemetrySubscriber>{new TelemetrySubscriber{
      Readers{std::move(*pulses), std::move(*coded)}, std::move(*waitset), queue, stored}};
}

TelemetrySubscriber::TelemetrySubscriber(Readers readers, bus::WaitSet waitset,
                                         BoundedQueue<SampleBatch>& queue,
                                         const LastOrigins& stored)
    : readers_{std::move(readers)}, waitset_{std::move(waitset)}, queue_{queue} {
  for (const Origin& last : stored.pulses) {
    tracker_.go_on(last, kPulses);
  }
  for (const Origin& last : stored.frames) {
    tracker_.go_on(last, kCodedFrames);
  }
  thread_ = std::thread{[this] { run(); }};
}

TelemetrySubscriber::~TelemetrySubscriber() { stop(); }

void TelemetrySubscriber::stop() {
  waitset_.stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

Expected<TelemetrySubscriberStatus> TelemetrySubscriber::status() const {
  auto reader = std::apply([](const auto&... all) { return status_of(all...); }, readers_);
  if (!reader) {
    return Unexpected{reader.error()};
  }
  const std::lock_guard lock{mutex_};
  return TelemetrySubscriberStatus{.by_source = tracker_.by_source(),
                                   .reader = std::move(*reader),
                                   .taking = taking_,
                                   .failure = failure_};
}

void TelemetrySubscriber::run() {
  const auto ended = take_until_stopped();
  const std::lock_guard lock{mutex_};
  taking_ = false;
  if (!ended) {
    failure_ = ended.error().message;
  }
}

Expected<void> TelemetrySubscriber::take_until_stopped() {
  while (true) {
    const auto more = waitset_.wait();
    if (!more) {
      return Unexpected{more.error()};
    }
    if (!*more) {
      return take_what_is_left();
    }
    if (const auto handed = hand_over_batches(); !handed) {
      return Unexpected{handed.error()};
    }
  }
}

// What the reader holds is acknowledged: its writers take it for stored. No more than that, or a
// fast writer would keep a stopping service going.
Expected<void> TelemetrySubscriber::take_what_is_left() {
  for (std::int32_t batch = 0; batch <= bus::kTelemetryReaderSamples / kTakenAtOnce; ++batch) {
    const auto handed = hand_over_batches();
    if (!handed) {
      return Unexpected{handed.error()};
    }
    if (!*handed) {
      break;
    }
  }
  return {};
}

// False: there was nothing to take.
Expected<bool> TelemetrySubscriber::hand_over_batches() {
  auto pulses = hand_over_batch<kPulses>();
  if (!pulses) {
    return pulses;
  }
  auto coded = hand_over_batch<kCodedFrames>();
  if (coded) {
    *coded = *coded || *pulses;
  }
  return coded;
}

template <std::size_t topic>
Expected<bool> TelemetrySubscriber::hand_over_batch() {
  auto batch = take_batch<topic>();
  if (!batch) {
    return Unexpected{batch.error()};
  }
  const bool empty = is_empty(*batch);
  if (!empty && !queue_.push(std::move(*batch))) {
    return Unexpected{
        Error{ErrorCode::Unavailable, "the queue of samples was closed while they arrive"}};
  }
  return !empty;
}

template <std::size_t topic>
Expected<SampleBatch> TelemetrySubscriber::take_batch() {
  SampleBatch batch;
  const std::lock_guard lock{mutex_};
  return std::get<topic>(readers_)
      .take([this, &batch](const auto& taken) {
        if (auto sample = from_idl(taken)) {
          tracker_.record(sample->origin, sample->spacecraft, topic);
          keep(std::move(*sample), batch);
        } else {
          const Origin origin = origin_from_idl(taken);
          tracker_.record(origin, taken.spacecraft, topic);
          batch.rejected.push_back(rejected_from_idl(origin, std::move(sample.error().message)));
        }
      })
      .map([this, &batch](std::size_t /*taken*/) {
        batch.counts = tracker_.take_changed();
        return std::move(batch);
      });
}

}  // namespace spindrift
