/// @file
/// Telemetry from the bus into a queue, on a thread that does nothing else.

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
#include "services/telemetry/last_origins.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

struct TelemetrySubscriberStatus {
  std::map<std::string, SequenceCounts> by_source;
  CountsBySpacecraft by_spacecraft;  ///< Of those with a mission here.
  bus::ReaderStatus reader;          ///< Of all topics together.
  bool taking;  ///< False: the thread ended, stopped or failed (see `failure`).
  std::string failure;
  std::uint64_t discarded;  ///< Acknowledged to their writers, but not queued when it stopped.
};

/// Takes from the topics of all kinds of telemetry for as long as it lives. When the queue is full
/// it waits, the reader fills up, and the writers feel the pressure: nothing is dropped. Samples of
/// other spacecraft are counted on the way and left to others.
class TelemetrySubscriber {
 public:
  /// `participant` and `queue` outlive it. @param spacecraft That have a mission here.
  /// @param stored Before a restart: no gap is counted again.
  /// @return Unavailable when Cyclone refuses.
  static Expected<std::unique_ptr<TelemetrySubscriber>> start(
      const bus::Participant& participant, BoundedQueue<SampleBatch>& queue,
      std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored = {});

  ~TelemetrySubscriber();
  TelemetrySubscriber(const TelemetrySubscriber&) = delete;
  TelemetrySubscriber& operator=(const TelemetrySubscriber&) = delete;
  TelemetrySubscriber(TelemetrySubscriber&&) = delete;
  TelemetrySubscriber& operator=(TelemetrySubscriber&&) = delete;

  /// Ends taking, however fast writers go on: what they were told is delivered is in the queue when
  /// this returns, and no reader is left. Until then somebody must go on emptying the queue; close
  /// it afterwards. Once is enough, from the thread that owns this.
  void stop();

  /// From any thread. @return Unavailable when Cyclone refuses.
  Expected<TelemetrySubscriberStatus> status() const;

 private:
  template <class Value>
  using ReaderOf = bus::Reader<bus::MessageOf<Value>>;
  using Readers = TelemetryKinds::Of<std::tuple, ReaderOf>;

  TelemetrySubscriber(const bus::Participant& participant, std::unique_ptr<Arrivals> arrivals,
                      Readers readers, bus::WaitSet waitset, BoundedQueue<SampleBatch>& queue);

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
  std::unique_ptr<Arrivals> arrivals_;  // Before the readers, whose filters use it.
  mutable std::mutex readers_mutex_;    // Guards that readers are there; the thread outlives none.
  std::optional<Readers> readers_;
  Expected<bus::ReaderStatus> last_reader_status_;  ///< Once they are gone.
  bus::WaitSet waitset_;
  BoundedQueue<SampleBatch>& queue_;
  WritingOrder order_;

  mutable std::mutex mutex_;  // Guards the three below.
  bool taking_ = true;
  std::string failure_;
  std::uint64_t discarded_ = 0;

  std::thread thread_;  // Last: it uses all the others, and begins once they are there.
};

}  // namespace spindrift
