/// @file
/// Reports once a second how the service is doing: on the bus, in the log and as alerts.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "services/archive/records.h"
#include "services/base/bounded_queue.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/processor/pass_input.h"
#include "services/serving/routing.h"
#include "services/serving/service_run.h"
#include "services/serving/service_watch.h"
#include "services/serving/verdict_watch.h"

namespace spindrift {

/// Passes on alerts of the service itself: announced at once, stored as soon as the archive works.
/// Used by one thread, which never waits for the archive.
class AlertOutbox {
 public:
  /// @param parts Must outlive this object.
  explicit AlertOutbox(const ServiceParts& parts);
  ~AlertOutbox();
  AlertOutbox(const AlertOutbox&) = delete;
  AlertOutbox& operator=(const AlertOutbox&) = delete;
  AlertOutbox(AlertOutbox&&) = delete;
  AlertOutbox& operator=(AlertOutbox&&) = delete;

  void push(ArchiveBatch batch);

 private:
  static constexpr std::size_t kMostWaiting = 1024;

  const ServiceParts& parts_;
  BoundedQueue<ArchiveBatch> waiting_{kMostWaiting};
  std::thread thread_;  // Declared last because it uses the other members.
};

class Heartbeat {
 public:
  /// All arguments must outlive the heartbeat.
  Heartbeat(const ServiceParts& parts, const Heard& heard, const TelemetrySubscriber& subscriber,
            const BoundedQueue<PassInput>& work);
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

  const ServiceParts& parts_;
  const Heard& heard_;
  const TelemetrySubscriber& subscriber_;
  const BoundedQueue<PassInput>& work_;
  AlertOutbox outbox_;
  ServiceWatch service_;
  VerdictWatch verdicts_;
  std::set<std::string> said_;
  GapWatch gap_watch_;
  std::map<std::string, std::uint64_t> gaps_;  ///< Lasting gaps as last reported.
  std::uint32_t lost_ = 0;
  int beats_not_storing_ = 0;
  bool failed_ = false;
  std::jthread thread_;  // Declared last because it uses the other members.
};

}  // namespace spindrift
