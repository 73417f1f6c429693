/// @file
/// Where operators' actions come into the running service, whichever way they were sent.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"
#include "services/actions/parse_action.h"
#include "services/archive/archive.h"
#include "services/queue/bounded_queue.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Used by any thread.
class ActionInbox {
 public:
  /// @param taken Of what is taken. It and the archive outlive it.
  ActionInbox(KnownSpacecraft known, const Archive& archive, BoundedQueue<SampleBatch>& taken)
      : known_{std::move(known)}, archive_{archive}, taken_{taken} {}

  /// Behind the samples that are taken already; where these have no room it waits.
  /// @return its action_id; as parse_action; Unavailable where nothing more is taken, or stored.
  Expected<std::string> take(const nlohmann::json& request);

 private:
  KnownSpacecraft known_;
  const Archive& archive_;
  BoundedQueue<SampleBatch>& taken_;
};

}  // namespace spindrift
