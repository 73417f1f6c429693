/// @file
/// The slow solutions that runs hand out, on threads that give way to others.

#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/processor/background_task.h"
#include "services/serving/patience.h"

namespace spindrift {

/// That wait: those of a minute of many spacecraft, or of hours in a replay.
inline constexpr std::size_t kMostBackgroundTasks = 256;

/// Those that people wait for have a queue and a thread of their own.
struct BackgroundTasks {
  BoundedQueue<BackgroundTask> usual{kMostBackgroundTasks};
  BoundedQueue<BackgroundTask> awaited{kMostBackgroundTasks};

  void push(BackgroundTask task) { (task.is_awaited ? awaited : usual).push(std::move(task)); }
  /// There is room: whoever pushes will not wait.
  bool is_roomy() const {
    return std::max(usual.size(), awaited.size()) < kMostBackgroundTasks / 2;
  }
};

/// Solves until `tasks` is closed and empty. What is left when patience ends it says: the next
/// start makes what is not stored.
/// @return How many are left.
std::size_t solve_in_background(BoundedQueue<BackgroundTask>& tasks, Archive& archive,
                                const Patience& patience);

/// Where this thread and those of samples want the processor it has a tenth of it: what is left to
/// be computed can wait, and samples cannot be had again.
void let_samples_come_first();

/// A solution was not awaited when patience ended: its thread goes on, until the process ends by
/// `_exit`.
bool is_solution_given_up();

}  // namespace spindrift
