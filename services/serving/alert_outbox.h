/// @file
/// Alerts of the service itself on their way out: announced at once, stored as soon as the archive
/// works.

#pragma once

#include <cstddef>
#include <functional>
#include <thread>

#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

/// Of one thread, which never waits for the archive.
class AlertOutbox {
 public:
  using Announce = std::function<void(const ArchiveBatch&)>;

  /// All of them outlive it. @param announce Does not wait.
  AlertOutbox(Archive& archive, AlertDesk& desk, Announce announce, ThreadFailures& failures);
  ~AlertOutbox();
  AlertOutbox(const AlertOutbox&) = delete;
  AlertOutbox& operator=(const AlertOutbox&) = delete;
  AlertOutbox(AlertOutbox&&) = delete;
  AlertOutbox& operator=(AlertOutbox&&) = delete;

  void push(ArchiveBatch batch);

 private:
  static constexpr std::size_t kMostWaiting = 1024;

  Archive& archive_;
  AlertDesk& desk_;
  Announce announce_;
  BoundedQueue<ArchiveBatch> waiting_{kMostWaiting};
  std::thread thread_;  // Last: it uses the others.
};

}  // namespace spindrift
