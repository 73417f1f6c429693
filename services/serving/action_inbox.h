/// @file
/// Accepts operators' actions into the running service, whichever way they were sent.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/base/bounded_queue.h"
#include "services/operator/parse_action.h"
#include "services/serving/stored_actions.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Accepts operators' actions. May be used by any thread.
class ActionInbox {
 public:
  /// All arguments must outlive the inbox. @param taken Queue that the actions go into.
  /// @param stored Is told of every commit.
  ActionInbox(KnownSpacecraft known, const Archive& archive, BoundedQueue<SampleBatch>& taken,
              StoredActions& stored)
      : known_{std::move(known)}, archive_{archive}, taken_{taken}, stored_{stored} {}

  /// Queues an action behind the samples that are queued already, even if the queue is full, and
  /// waits until it is stored. @return The action_id; errors as parse_action; Unavailable when the
  /// service stops, too many actions wait, or the action is not stored within 5 s.
  Expected<std::string> take(const nlohmann::json& request);

 private:
  KnownSpacecraft known_;
  const Archive& archive_;
  BoundedQueue<SampleBatch>& taken_;
  StoredActions& stored_;
};

}  // namespace spindrift
