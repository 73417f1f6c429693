/// @file
/// The slow solutions that runs hand out, on a thread that gives way to all others.

#pragma once

#include <cstddef>

#include "services/archive/archive.h"
#include "services/processor/background_task.h"
#include "services/queue/bounded_queue.h"
#include "services/spindrift/patience.h"

namespace spindrift {

/// That wait: those of a minute of many spacecraft, or of hours in a replay.
inline constexpr std::size_t kMostBackgroundTasks = 256;

/// Solves until `tasks` is closed and empty. What is left when patience ends it says: the next
/// start makes what is not stored.
/// @return How many are left.
std::size_t solve_in_background(BoundedQueue<BackgroundTask>& tasks, Archive& archive,
                                const Patience& patience);

/// A solution was not awaited when patience ended: its thread goes on, until the process ends by
/// `_exit`.
bool is_solution_given_up();

}  // namespace spindrift
