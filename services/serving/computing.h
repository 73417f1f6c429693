/// @file
/// The computing of `serve`, on the routing thread or on a thread of its own.

#pragma once

#include <atomic>
#include <cstddef>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/processor/processor.h"
#include "services/serving/background_solving.h"

namespace spindrift {

/// Turns samples into products in the order in which they were routed. While nothing waits, the
/// routing thread computes itself, which saves a fix the delay of a second thread. Samples that
/// come faster wait for the backlog thread, so that they reach the archive however long computing
/// takes.
class Computing {
 public:
  /// All arguments must outlive this object.
  /// @param tasks Receives the slow solutions that become due.
  Computing(Processor& processor, Archive& archive, BoundedQueue<PassInput>& backlog,
            BackgroundTasks& tasks, const Patience& patience)
      : processor_{processor},
        archive_{archive},
        backlog_{backlog},
        tasks_{tasks},
        patience_{patience} {}

  /// @name To be called by the routing thread only
  /// @{
  /// @param batches_behind Number of batches that wait to be routed.
  /// @return The archive's refusal.
  Expected<void> enqueue(PassInput input, std::size_t batches_behind);
  void leave_to_backlog(PassInput input);
  /// @}

  /// Computes, on the backlog thread, until the backlog is drained or the archive refuses.
  Expected<void> work_off();

  /// Returns how many samples impatience left uncomputed. Valid when both threads have ended.
  std::size_t samples_left() const { return samples_left_; }

 private:
  Expected<void> compute(const PassInput& input);

  Processor& processor_;
  Archive& archive_;
  BoundedQueue<PassInput>& backlog_;
  BackgroundTasks& tasks_;
  const Patience& patience_;
  std::atomic<std::size_t> waiting_ = 0;  ///< Zero when the backlog thread is at rest.
  std::size_t samples_left_ = 0;
};

}  // namespace spindrift
