/// @file
/// Sends alerts of the service itself: announced at once, stored as soon as the archive works.

#pragma once

#include <cstddef>
#include <functional>
#include <thread>

#include "services/alerts/alert_desk.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/serving/thread_failures.h"

namespace spindrift {

/// Passes on alerts. Used by one thread, which never waits for the archive.
class AlertOutbox {
 public:
  using Announce = std::function<void(const ArchiveBatch&)>;

  /// All arguments must outlive this object. @param announce Must not wait.
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
  std::thread thread_;  // Declared last because it uses the other members.
};

}  // namespace spindrift
