/// @file
/// Reports once a second how the service is doing: on the bus, in the log and as alerts.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "services/archive/archive.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/processor/pass_input.h"
#include "services/processor/problems.h"
#include "services/publisher/result_publisher.h"
#include "services/serving/alert_outbox.h"
#include "services/serving/gap_watch.h"
#include "services/serving/link_watch.h"
#include "services/serving/service_watch.h"
#include "services/serving/thread_failures.h"
#include "services/serving/verdict_watch.h"

namespace spindrift {

class Heartbeat {
 public:
  /// The parts of the service to report on. All must outlive the heartbeat.
  struct Watched {
    const TelemetrySubscriber& subscriber;
    const BoundedQueue<SampleBatch>& taken;
    const BoundedQueue<PassInput>& work;
    const Archive& archive;
    const ResultPublisher& publisher;
    const LinkWatch& links;
    const VerdictWatch& verdicts;
    const Problems& problems;
    ServiceWatch& service;
    AlertDesk& desk;
    AlertOutbox& outbox;
    std::function<void(const Health&)> on_health;  ///< Must not wait.
  };

  /// @param failures Is told when taking samples fails; must outlive the heartbeat.
  Heartbeat(Watched watched, ThreadFailures& failures);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  Heartbeat(Heartbeat&&) = delete;
  Heartbeat& operator=(Heartbeat&&) = delete;

 private:
  void run(const std::stop_token& stop);
  void beat();
  std::vector<std::string> problems(const TelemetrySubscriberStatus& status,
                                    const std::optional<Error>& archive_failure) const;
  void note_losses(const TelemetrySubscriberStatus& status);
  void note_storing(const std::optional<Error>& failure);
  std::vector<SpacecraftHealth> spacecraft() const;
  void publish_health(const TelemetrySubscriberStatus& status);
  void supervise(const TelemetrySubscriberStatus& status);
  void say_once(const std::string& problem);

  Watched watched_;
  ThreadFailures& failures_;
  std::set<std::string> said_;
  GapWatch gap_watch_;
  std::map<std::string, std::uint64_t> gaps_;  ///< Lasting gaps as last reported.
  std::uint32_t lost_ = 0;
  int beats_not_storing_ = 0;
  bool failed_ = false;
  std::jthread thread_;  // Declared last because it uses the other members.
};

}  // namespace spindrift
