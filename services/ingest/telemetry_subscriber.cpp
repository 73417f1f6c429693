#include "services/ingest/telemetry_subscriber.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "services/base/contained.h"
#include "services/base/wall_clock.h"
#include "services/ingest/from_idl.h"

namespace spindrift {
namespace {

// Most samples that Reader::take gives in one call.
constexpr std::size_t kTakenAtOnce = 256;
// Samples of other spacecraft do not wake the thread; it passes on their counts this often.
constexpr std::chrono::seconds kBeat{1};
// Limit of what a stop takes: a full reader, and as much again that Cyclone still delivers.
constexpr std::int32_t kBatchesLeft = 2 * bus::kTelemetryReaderSamples / std::int32_t{kTakenAtOnce};
// Time for Cyclone's threads to deliver what they have received.
constexpr std::chrono::milliseconds kInHand{20};

template <class Value>
Expected<bus::Reader<bus::MessageOf<Value>>> attached_reader(const bus::Participant& participant,
                                                             bus::WaitSet& waitset,
                                                             Arrivals& arrivals) {
  const auto is_ours = [&arrivals](const bus::MessageOf<Value>& message) {
    const bool ours = arrivals.is_ours(message.spacecraft);
    if (!ours) {
      arrivals.take_other<Value>(message);
    }
    return ours;
  };
  auto reader = bus::Reader<bus::MessageOf<Value>>::create(participant, bus::topic_of<Value>(),
                                                           bus::telemetry_reader_qos(), is_ours);
  if (reader) {
    if (const auto attached = waitset.attach(reader->data()); !attached) {
      return Unexpected{attached.error()};
    }
  }
  return reader;
}

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
                      Arrivals& arrivals, KindList<Kinds...> /*kinds*/) {
  return all_of(attached_reader<Kinds>(participant, waitset, arrivals)...);
}

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
    std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored) {
  auto waitset = bus::WaitSet::create(participant);
  if (!waitset) {
    return Unexpected{waitset.error()};
  }
  auto arrivals = std::make_unique<Arrivals>(std::move(spacecraft), stored);
  auto readers = attached_readers(participant, *waitset, *arrivals, TelemetryKinds{});
  if (!readers) {
    return Unexpected{readers.error()};
  }
  return std::unique_ptr<TelemetrySubscriber>{new TelemetrySubscriber{
      participant, std::move(arrivals), std::move(*readers), std::move(*waitset), queue, stored}};
}

TelemetrySubscriber::TelemetrySubscriber(const bus::Participant& participant,
                                         std::unique_ptr<Arrivals> arrivals, Readers readers,
                                         bus::WaitSet waitset, BoundedQueue<SampleBatch>& queue,
                                         const LastOrigins& stored)
    : participant_{participant},
      arrivals_{std::move(arrivals)},
      readers_{std::move(readers)},
      waitset_{std::move(waitset)},
      queue_{queue},
      order_{stored} {
  thread_ = std::thread{[this] { run(); }};
}

TelemetrySubscriber::~TelemetrySubscriber() { stop(); }

// The participant is made deaf until the readers are empty and deleted. Otherwise a full reader
// would block Cyclone's receive thread, and deleting any reader waits for that thread: for ever,
// since nobody can take from a reader that is being deleted.
void TelemetrySubscriber::stop() {
  if (!readers_) {
    return;
  }
  participant_.set_deaf(true);
  waitset_.stop();
  if (thread_.joinable()) {
    thread_.join();
  }
  discard_what_is_left();
  {
    const std::lock_guard lock{readers_mutex_};
    last_reader_status_ = reader_status();
    readers_.reset();
  }
  participant_.set_deaf(false);
}

// Discards what the readers hold: nothing unless the queue was closed or the thread failed.
void TelemetrySubscriber::discard_what_is_left() {
  const auto discard = [this](const auto& reader) {
    std::size_t taken = 1;
    for (std::int32_t batch = 0; batch < kBatchesLeft && taken > 0; ++batch) {
      taken = reader.take([this](const auto& /*sample*/) { ++discarded_; }).value_or(0);
    }
  };
  const std::lock_guard lock{mutex_};
  discarded_ += count_of(order_.rest().samples);
  std::apply([&](const auto&... all) { (discard(all), ...); }, *readers_);
}

Expected<bus::ReaderStatus> TelemetrySubscriber::reader_status() const {
  return readers_ ? std::apply([](const auto&... all) { return status_of(all...); }, *readers_)
                  : last_reader_status_;
}

Expected<TelemetrySubscriberStatus> TelemetrySubscriber::status() const {
  std::unique_lock readers_lock{readers_mutex_};
  auto reader = reader_status();
  readers_lock.unlock();
  if (!reader) {
    return Unexpected{reader.error()};
  }
  const std::lock_guard lock{mutex_};
  return TelemetrySubscriberStatus{.by_source = arrivals_->by_source(),
                                   .by_spacecraft = arrivals_->by_spacecraft(),
                                   .reader = std::move(*reader),
                                   .taking = taking_,
                                   .failure = failure_,
                                   .discarded = discarded_};
}

void TelemetrySubscriber::run() {
  const auto ended = contained("taking samples", [this] { return take_until_stopped(); });
  const std::lock_guard lock{mutex_};
  taking_ = false;
  if (!ended) {
    failure_ = ended.error().message;
  }
}

Expected<void> TelemetrySubscriber::take_until_stopped() {
  while (true) {
    const auto more = waitset_.wait(until_next_look());
    if (!more) {
      return Unexpected{more.error()};
    }
    if (!*more) {
      return take_what_is_left();
    }
    if (const auto handed = hand_over_batches(); !handed) {
      return Unexpected{handed.error()};
    }
    if (auto handed = hand_over_rest(tai_now()); !handed) {
      return handed;
    }
  }
}

// Takes the rest from the readers, which is acknowledged, so that its writers consider it
// delivered. Other processes send nothing more, but a writer in this process may; the number of
// rounds is limited so that it cannot keep a stopping service running.
Expected<void> TelemetrySubscriber::take_what_is_left() {
  bool waited = false;
  for (std::int32_t batch = 0; batch < kBatchesLeft; ++batch) {
    const auto handed = hand_over_batches();
    if (!handed) {
      return Unexpected{handed.error()};
    }
    if (!*handed && waited) {
      break;
    }
    if (!*handed) {
      std::this_thread::sleep_for(kInHand);
    }
    waited = !*handed;
  }
  if (auto handed = hand_over(order_.rest()); !handed) {
    return handed;
  }
  return hand_over_rest(TaiTime::max());
}

std::chrono::nanoseconds TelemetrySubscriber::until_next_look() const {
  if (!order_.holds_some()) {
    return kBeat;
  }
  const auto until = order_.wait_until();
  return until ? std::max<std::chrono::nanoseconds>(*until - std::chrono::steady_clock::now(), {})
               : std::chrono::nanoseconds{0};
}

// Returns false when there was nothing to take.
Expected<bool> TelemetrySubscriber::hand_over_batches() {
  auto taken = take_from_all();
  if (!taken) {
    return Unexpected{std::move(taken.error())};
  }
  const bool some = !is_empty(*taken);
  SampleBatch complete = order_.pass_on(std::move(*taken), std::chrono::steady_clock::now());
  return hand_over(std::move(complete)).map([some] { return some; });
}

Expected<SampleBatch> TelemetrySubscriber::take_from_all() {
  SampleBatch taken;
  Expected<void> done;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    done = done.and_then([&] { return this->take_from<Value>(taken); });
  });
  return done.map([&] { return std::move(taken); });
}

// Takes at most what the reader can hold; later arrivals wait for the next call.
template <class Value>
Expected<void> TelemetrySubscriber::take_from(SampleBatch& batch) {
  std::size_t all = 0;
  Expected<std::size_t> taken = kTakenAtOnce;
  while (taken && *taken == kTakenAtOnce && all < bus::kTelemetryReaderSamples) {
    taken = std::get<kTelemetryKind<Value>>(*readers_).take(
        [&](const bus::MessageOf<Value>& message, std::int64_t written_ns) {
          arrivals_->accept<Value>(message, written_ns, batch);
        });
    all += taken.value_or(0);
  }
  return taken.map([](std::size_t) {});
}

Expected<void> TelemetrySubscriber::hand_over(SampleBatch batch) {
  if (is_empty(batch)) {
    return {};
  }
  batch.counts = arrivals_->count(batch.samples);
  return push(std::move(batch));
}

Expected<void> TelemetrySubscriber::hand_over_rest(TaiTime now) {
  SampleBatch rest = arrivals_->take_rest(now);
  return is_empty(rest) ? Expected<void>{} : push(std::move(rest));
}

Expected<void> TelemetrySubscriber::push(SampleBatch batch) {
  const std::size_t samples = count_of(batch.samples);
  batch.came = std::chrono::steady_clock::now();
  if (!queue_.push(std::move(batch))) {
    const std::lock_guard lock{mutex_};
    discarded_ += samples;
    return Unexpected{
        Error{ErrorCode::Unavailable, "the queue of samples was closed while they arrive"}};
  }
  return {};
}

}  // namespace spindrift
