/// @file
/// Solves the slow solutions that runs hand out, on threads that give way to others.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/processor/background_task.h"

namespace spindrift {

/// Tells the threads of `serve` how long they may go on.
struct Patience {
  std::atomic<bool> stopping = false;
  std::atomic<bool> ended = false;  ///< Stored samples are no longer computed.
};

/// Limit of waiting tasks: enough for a minute of many spacecraft, or for hours of a replay.
inline constexpr std::size_t kMostBackgroundTasks = 256;

/// Queues slow solutions; those that users wait for have their own queue and thread.
struct BackgroundTasks {
  BoundedQueue<BackgroundTask> usual{kMostBackgroundTasks};
  BoundedQueue<BackgroundTask> awaited{kMostBackgroundTasks};

  void push(BackgroundTask task) { (task.is_awaited ? awaited : usual).push(std::move(task)); }
  /// Returns whether both queues have room, so that `push` will not wait.
  bool is_roomy() const {
    return std::max(usual.size(), awaited.size()) < kMostBackgroundTasks / 2;
  }
};

/// Solves tasks until `tasks` is closed and empty. Tasks left when patience ends are reported in
/// the log; the next start solves those that are not stored. @return Number of tasks left.
std::size_t solve_in_background(BoundedQueue<BackgroundTask>& tasks, Archive& archive,
                                const Patience& patience);

/// Lowers the priority of the calling thread, so that threads that take samples get the processor
/// first (about ten times its share): what is left to be computed can wait, and samples cannot be
/// had again.
void let_samples_come_first();

/// Returns whether an unfinished solution was left running until the process ends by `_exit`.
bool is_solution_given_up();

}  // namespace spindrift
