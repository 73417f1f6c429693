#include "services/serving/thread_failures.h"

#include <spdlog/spdlog.h>

#include "services/serving/stop_signal.h"

namespace spindrift {

void ThreadFailures::report(const Expected<void>& ended) {
  if (ended) {
    return;
  }
  spdlog::critical("{}: the service stops", ended.error().message);
  {
    const std::lock_guard lock{mutex_};
    if (first_) {
      first_ = ended;
    }
  }
  StopSignal::raise();
}

Expected<void> ThreadFailures::first() const {
  const std::lock_guard lock{mutex_};
  return first_;
}

}  // namespace spindrift
