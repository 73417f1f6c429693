/// @file
/// Takes telemetry from the bus into a queue, on a thread of its own.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <tuple>

#include "services/base/bounded_queue.h"
#include "services/bus/reader.h"
#include "services/bus/telemetry_messages.h"
#include "services/bus/wait_set.h"
#include "services/ingest/arrivals.h"
#include "services/ingest/writing_order.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

struct TelemetrySubscriberStatus {
  std::map<std::string, SequenceCounts> by_source;
  CountsBySpacecraft by_spacecraft;  ///< Only spacecraft with a mission here.
  bus::ReaderStatus reader;          ///< Summed over all topics.
  bool taking;                       ///< False when the thread stopped or failed (see `failure`).
  std::string failure;
  std::uint64_t discarded;  ///< Samples acknowledged to their writers but not queued.
};

/// Takes samples from the topics of all kinds of telemetry as long as it exists. When the queue is
/// full it waits, the reader fills up and the writers are held back: no sample is dropped. Samples
/// of other spacecraft are counted and left to other services.
class TelemetrySubscriber {
 public:
  /// Creates the readers and starts the thread. `participant` and `queue` must outlive the
  /// subscriber. @param spacecraft Spacecraft that have a mission here.
  /// @param stored Origins stored before a restart; their gaps are not counted again, and new
  /// samples wait for the topics to come that far again.
  /// @return Unavailable when Cyclone refuses.
  static Expected<std::unique_ptr<TelemetrySubscriber>> start(
      const bus::Participant& participant, BoundedQueue<SampleBatch>& queue,
      std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored = {});

  ~TelemetrySubscriber();
  TelemetrySubscriber(const TelemetrySubscriber&) = delete;
  TelemetrySubscriber& operator=(const TelemetrySubscriber&) = delete;
  TelemetrySubscriber(TelemetrySubscriber&&) = delete;
  TelemetrySubscriber& operator=(TelemetrySubscriber&&) = delete;

  /// Stops taking samples, however fast writers go on. When it returns, every sample acknowledged
  /// to its writer is in the queue, and the readers are gone. Until then the queue must be emptied;
  /// it is to be closed afterwards. To be called from the thread that owns the subscriber; further
  /// calls do nothing.
  void stop();

  /// Returns counts and state. May be called from any thread.
  /// @return Unavailable when Cyclone refuses.
  Expected<TelemetrySubscriberStatus> status() const;

 private:
  template <class Value>
  using ReaderOf = bus::Reader<bus::MessageOf<Value>>;
  using Readers = TelemetryKinds::Of<std::tuple, ReaderOf>;

  TelemetrySubscriber(const bus::Participant& participant, std::unique_ptr<Arrivals> arrivals,
                      Readers readers, bus::WaitSet waitset, BoundedQueue<SampleBatch>& queue,
                      const LastOrigins& stored);

  void run();
  Expected<void> take_until_stopped();
  Expected<void> take_what_is_left();
  Expected<SampleBatch> take_from_all();
  template <class Value>
  Expected<void> take_from(SampleBatch& batch);
  Expected<bool> hand_over_batches();
  Expected<void> hand_over(SampleBatch batch);
  std::chrono::nanoseconds until_next_look() const;
  Expected<void> hand_over_rest(TaiTime now);
  Expected<void> push(SampleBatch batch);
  void discard_what_is_left();
  Expected<bus::ReaderStatus> reader_status() const;

  const bus::Participant& participant_;
  std::unique_ptr<Arrivals> arrivals_;  // Declared before the readers, whose filters use it.
  // Guards the existence of the readers; the thread does not outlive them.
  mutable std::mutex readers_mutex_;
  std::optional<Readers> readers_;
  Expected<bus::ReaderStatus> last_reader_status_;
  bus::WaitSet waitset_;
  BoundedQueue<SampleBatch>& queue_;
  WritingOrder order_;

  mutable std::mutex mutex_;  // Guards the three members below.
  bool taking_ = true;
  std::string failure_;
  std::uint64_t discarded_ = 0;

  std::thread thread_;  // Declared last because it uses the other members.
};

}  // namespace spindrift
