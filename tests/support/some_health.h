/// @file
/// Health of a service, all its numbers different.

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

/// Nothing is stored.
inline Health failing_health() {
  Health health = some_health();
  health.status = "not storing: disk full";
  health.works = false;
  return health;
}

}  // namespace spindrift::testing
