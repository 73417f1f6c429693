/// @file
/// The batch solutions of each minute, on a thread that gives way to all others.

#pragma once

#include <cstddef>

#include "services/archive/archive.h"
#include "services/processor/batch_task.h"
#include "services/queue/bounded_queue.h"
#include "services/spindrift/patience.h"

namespace spindrift {

/// That wait: those of a minute of many spacecraft, or of hours in a replay.
inline constexpr std::size_t kMostBatchTasks = 256;

/// Solves until `tasks` is closed and empty, or patience ends: the end of a run has a solution of
/// its own.
void solve_batches(BoundedQueue<BatchTask>& tasks, Archive& archive, const Patience& patience);

}  // namespace spindrift
