#include "services/ingest/telemetry_subscriber.h"

#include <utility>

#include "services/ingest/from_idl.h"

namespace spindrift {
namespace {

// So many does Reader::take give at a time while there are more.
constexpr std::int32_t kTakenAtOnce = 256;

template <class Value>
Expected<bus::Reader<bus::MessageOf<Value>>> attached_reader(const bus::Participant& participant,
                                                             bus::WaitSet& waitset) {
  auto reader = bus::Reader<bus::MessageOf<Value>>::create(participant, bus::topic_of<Value>(),
                                                           bus::telemetry_reader_qos());
  if (reader) {
    if (const auto attached = waitset.attach(reader->data()); !attached) {
      return Unexpected{attached.error()};
    }
  }
  return reader;
}

/// All of `each`, or the first error among them.
template <class... Values>
Expected<std::tuple<Values...>> all_of(Expected<Values>... each) {
  const Error* failure = nullptr;
  ((failure = failure == nullptr && !each ? &each.error() : failure), ...);
  if (failure != nullptr) {
    return Unexpected{*failure};
  }
  return std::tuple<Values...>{std::move(*each)...};
}

template <class... Kinds>
auto attached_readers(const bus::Participant& participant, bus::WaitSet& waitset,
                      KindList<Kinds...> /*kinds*/) {
  return all_of(attached_reader<Kinds>(participant, waitset)...);
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

}  // namespace

Expected<std::unique_ptr<TelemetrySubscriber>> TelemetrySubscriber::start(
    const bus::Participant& participant, BoundedQueue<SampleBatch>& queue,
    const LastOrigins& stored) {
  auto waitset = bus::WaitSet::create(participant);
  if (!waitset) {
    return Unexpected{waitset.error()};
  }
  auto readers = attached_readers(participant, *waitset, TelemetryKinds{});
  if (!readers) {
    return Unexpected{readers.error()};
  }
  return std::unique_ptr<TelemetrySubscriber>{
      new TelemetrySubscriber{std::move(*readers), std::move(*waitset), queue, stored}};
}

TelemetrySubscriber::TelemetrySubscriber(Readers readers, bus::WaitSet waitset,
                                         BoundedQueue<SampleBatch>& queue,
                                         const LastOrigins& stored)
    : readers_{std::move(readers)}, waitset_{std::move(waitset)}, queue_{queue} {
  for (std::size_t kind = 0; kind < stored.size(); ++kind) {
    for (const Origin& last : stored.at(kind)) {
      tracker_.go_on(last, kind);
    }
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
  Expected<bool> some = false;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    if (some) {
      const bool before = *some;
      some = hand_over_batch<Value>().map([before](bool now) { return before || now; });
    }
  });
  return some;
}

template <class Value>
Expected<bool> TelemetrySubscriber::hand_over_batch() {
  auto batch = take_batch<Value>();
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

template <class Value>
Expected<SampleBatch> TelemetrySubscriber::take_batch() {
  constexpr std::size_t kTopic = kTelemetryKind<Value>;
  SampleBatch batch;
  const std::lock_guard lock{mutex_};
  return std::get<kTopic>(readers_)
      .take([this, &batch](const bus::MessageOf<Value>& taken) {
        if (auto sample = from_idl<Value>(taken)) {
          tracker_.record(sample->origin, sample->spacecraft, kTopic);
          batch.samples.of<Value>().push_back(std::move(*sample));
        } else {
          const Origin origin = origin_from_idl(taken);
          tracker_.record(origin, taken.spacecraft, kTopic);
          batch.rejected.push_back(rejected_from_idl(origin, std::move(sample.error().message)));
        }
      })
      .map([this, &batch](std::size_t /*taken*/) {
        batch.counts = tracker_.take_changed();
        return std::move(batch);
      });
}

}  // namespace spindrift
