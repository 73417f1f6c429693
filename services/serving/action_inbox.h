/// @file
/// Where operators' actions come into the running service, whichever way they were sent.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"
#include "services/actions/parse_action.h"
#include "services/queue/bounded_queue.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Used by any thread.
class ActionInbox {
 public:
  /// @param taken Of what is taken, which outlives it.
  ActionInbox(KnownSpacecraft known, BoundedQueue<SampleBatch>& taken)
      : known_{std::move(known)}, taken_{taken} {}

  /// Behind the samples that are taken already; where these have no room it waits.
  /// @return its action_id; as parse_action; Unavailable where nothing more is taken.
  Expected<std::string> take(const nlohmann::json& request);

 private:
  KnownSpacecraft known_;
  BoundedQueue<SampleBatch>& taken_;
};

}  // namespace spindrift
