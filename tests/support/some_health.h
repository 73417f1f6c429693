/// @file
/// A sample health report of a service in which all numbers differ.

#pragma once

#include "services/publisher/health.h"

namespace spindrift::testing {

inline Health some_health() {
  return {.t = {},
          .samples_received = 6,
          .samples_committed = 5,
          .gaps = 4,
          .duplicates = 3,
          .queue_depth = 2,
          .commit_p99_ms = 1.5,
          .status = "ok",
          .message = {}};
}

/// Returns the health of a service that cannot store anything.
inline Health failing_health() {
  Health health = some_health();
  health.status = "not storing: disk full";
  health.works = false;
  return health;
}

}  // namespace spindrift::testing
