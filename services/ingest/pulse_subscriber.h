/// @file
/// Pulses from the bus into a queue, on a thread that does nothing else.

#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "services/bus/reader.h"
#include "services/bus/wait_set.h"
#include "services/ingest/sample_batch.h"
#include "services/ingest/sequence_tracker.h"
#include "services/queue/bounded_queue.h"

namespace spindrift {

struct PulseSubscriberStatus {
  std::map<std::string, SequenceCounts> by_source;
  bus::ReaderStatus reader;
  bool taking;  ///< False: the thread ended, stopped or failed (see `failure`).
  std::string failure;
};

/// Takes from spindrift/pulse for as long as it lives. When the queue is full it waits, the reader
/// fills up, and the writers feel the pressure: nothing is dropped.
class PulseSubscriber {
 public:
  /// `participant` and `queue` outlive it. @return Unavailable when Cyclone refuses.
  static Expected<std::unique_ptr<PulseSubscriber>> start(const bus::Participant& participant,
                                                          BoundedQueue<SampleBatch>& queue);

  ~PulseSubscriber();
  PulseSubscriber(const PulseSubscriber&) = delete;
  PulseSubscriber& operator=(const PulseSubscriber&) = delete;
  PulseSubscriber(PulseSubscriber&&) = delete;
  PulseSubscriber& operator=(PulseSubscriber&&) = delete;

  /// Ends taking: what was taken is in the queue when this returns. Until then somebody must go on
  /// emptying the queue; close it afterwards. Once is enough, from the thread that owns this.
  void stop();

  /// From any thread. @return Unavailable when Cyclone refuses.
  Expected<PulseSubscriberStatus> status() const;

 private:
  PulseSubscriber(bus::Reader<spindrift_Pulse> reader, bus::WaitSet waitset,
                  BoundedQueue<SampleBatch>& queue);

  void run();
  Expected<void> take_until_stopped();
  Expected<void> take_what_is_left();
  Expected<bool> hand_over_batch();
  Expected<SampleBatch> take_batch();

  bus::Reader<spindrift_Pulse> reader_;
  bus::WaitSet waitset_;
  BoundedQueue<SampleBatch>& queue_;

  mutable std::mutex mutex_;  // Guards the three below.
  SequenceTracker tracker_;
  bool taking_ = true;
  std::string failure_;

  std::thread thread_;  // Last: it uses all the others.
};

}  // namespace spindrift
