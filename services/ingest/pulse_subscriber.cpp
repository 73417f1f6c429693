#include "services/ingest/pulse_subscriber.h"

#include <utility>

#include "services/ingest/from_idl.h"

namespace spindrift {
namespace {

// So many does Reader::take give at a time while there are more.
constexpr std::int32_t kTakenAtOnce = 256;

}  // namespace

Expected<std::unique_ptr<PulseSubscriber>> PulseSubscriber::start(
    const bus::Participant& participant, BoundedQueue<SampleBatch>& queue) {
  auto waitset = bus::WaitSet::create(participant);
  if (!waitset) {
    return Unexpected{waitset.error()};
  }
  auto reader = bus::Reader<spindrift_Pulse>::create(participant, bus::kPulseTopic,
                                                     bus::telemetry_reader_qos());
  if (!reader) {
    return Unexpected{reader.error()};
  }
  if (const auto attached = waitset->attach(reader->data()); !attached) {
    return Unexpected{attached.error()};
  }
  return std::unique_ptr<PulseSubscriber>{
      new PulseSubscriber{std::move(*reader), std::move(*waitset), queue}};
}

PulseSubscriber::PulseSubscriber(bus::Reader<spindrift_Pulse> reader, bus::WaitSet waitset,
                                 BoundedQueue<SampleBatch>& queue)
    : reader_{std::move(reader)}, waitset_{std::move(waitset)}, queue_{queue}, thread_{[this] {
        run();
      }} {}

PulseSubscriber::~PulseSubscriber() { stop(); }

void PulseSubscriber::stop() {
  waitset_.stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

Expected<PulseSubscriberStatus> PulseSubscriber::status() const {
  auto reader = reader_.status();
  if (!reader) {
    return Unexpected{reader.error()};
  }
  const std::lock_guard lock{mutex_};
  return PulseSubscriberStatus{.by_source = tracker_.by_source(),
                               .reader = std::move(*reader),
                               .taking = taking_,
                               .failure = failure_};
}

void PulseSubscriber::run() {
  const auto ended = take_until_stopped();
  const std::lock_guard lock{mutex_};
  taking_ = false;
  if (!ended) {
    failure_ = ended.error().message;
  }
}

Expected<void> PulseSubscriber::take_until_stopped() {
  while (true) {
    const auto more = waitset_.wait();
    if (!more) {
      return Unexpected{more.error()};
    }
    if (!*more) {
      return take_what_is_left();
    }
    if (const auto handed = hand_over_batch(); !handed) {
      return Unexpected{handed.error()};
    }
  }
}

// What the reader holds is acknowledged: its writers take it for stored. No more than that, or a
// fast writer would keep a stopping service going.
Expected<void> PulseSubscriber::take_what_is_left() {
  for (std::int32_t batch = 0; batch <= bus::kTelemetryReaderSamples / kTakenAtOnce; ++batch) {
    const auto handed = hand_over_batch();
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
Expected<bool> PulseSubscriber::hand_over_batch() {
  auto batch = take_batch();
  if (!batch) {
    return Unexpected{batch.error()};
  }
  const bool empty = batch->pulses.empty() && batch->rejected.empty();
  if (!empty && !queue_.push(std::move(*batch))) {
    return Unexpected{
        Error{ErrorCode::Unavailable, "the queue of pulses was closed while they arrive"}};
  }
  return !empty;
}

Expected<SampleBatch> PulseSubscriber::take_batch() {
  SampleBatch batch;
  const std::lock_guard lock{mutex_};
  return reader_
      .take([this, &batch](const spindrift_Pulse& pulse) {
        const Origin origin = origin_from_idl(pulse);
        tracker_.record(origin, pulse.spacecraft);
        batch.counts.insert_or_assign(tracker_.entry_of(origin.source).first,
                                      tracker_.entry_of(origin.source).second);
        if (auto sample = from_idl(pulse)) {
          batch.pulses.push_back(std::move(*sample));
        } else {
          batch.rejected.push_back(rejected_from_idl(pulse, std::move(sample.error().message)));
        }
      })
      .map([&batch](std::size_t /*taken*/) { return std::move(batch); });
}

}  // namespace spindrift
