/// @file
/// Once a second: how the service is doing, on the bus, in the log and in the archive.

#pragma once

#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "services/archive/archive.h"
#include "services/ingest/pulse_subscriber.h"
#include "services/publisher/result_publisher.h"

namespace spindrift {

/// What came in from each sender so far.
std::vector<SourceCount> source_counts(const PulseSubscriberStatus& status);

class Heartbeat {
 public:
  /// All of them outlive it.
  struct Watched {
    const PulseSubscriber& subscriber;
    const BoundedQueue<PulseBatch>& queue;
    const Archive& archive;
    const ResultPublisher& publisher;
  };

  /// @param on_failure Called once, on its thread, when taking samples has failed.
  Heartbeat(const Watched& watched, std::function<void()> on_failure);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  Heartbeat(Heartbeat&&) = delete;
  Heartbeat& operator=(Heartbeat&&) = delete;

 private:
  void run(const std::stop_token& stop);
  void beat();
  void say_once(const std::string& problem);

  Watched watched_;
  std::function<void()> on_failure_;
  std::string service_;
  std::set<std::string> said_;
  std::uint64_t gaps_ = 0;
  std::uint32_t lost_ = 0;
  bool failed_ = false;
  std::jthread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
