/// @file
/// The mathematics of `serve`: on the thread that routes while little comes, else on its own.

#pragma once

#include <atomic>
#include <cstddef>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/processor/processor.h"
#include "services/serving/background_solving.h"
#include "services/serving/patience.h"

namespace spindrift {

/// Samples become products in the order in which they were routed. The thread that routes computes
/// them itself while nothing waits, which spares a fix the way through another; what comes faster
/// waits for the thread that works off the backlog, and samples reach the archive however long the
/// mathematics takes.
class Computing {
 public:
  /// All of them outlive it. @param tasks Solutions that become due.
  Computing(Processor& processor, Archive& archive, BoundedQueue<PassInput>& backlog,
            BackgroundTasks& tasks, const Patience& patience)
      : processor_{processor},
        archive_{archive},
        backlog_{backlog},
        tasks_{tasks},
        patience_{patience} {}

  /// @name Of the one thread that routes
  /// @{
  /// @param batches_behind Wait to be routed. @return the archive's refusal.
  Expected<void> take(PassInput input, std::size_t batches_behind);
  void leave_to_backlog(PassInput input);
  /// @}

  /// Until the backlog is closed and empty, or the archive refuses. On a thread of its own.
  Expected<void> work_off();

  /// Samples that were not computed, since patience had ended. Once both threads are done.
  std::size_t samples_left() const { return samples_left_; }

 private:
  Expected<void> compute(const PassInput& input);

  Processor& processor_;
  Archive& archive_;
  BoundedQueue<PassInput>& backlog_;
  BackgroundTasks& tasks_;
  const Patience& patience_;
  std::atomic<std::size_t> waiting_ = 0;  ///< 0: the thread that works off is at rest.
  std::size_t samples_left_ = 0;
};

}  // namespace spindrift
