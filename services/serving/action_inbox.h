/// @file
/// Where operators' actions come into the running service, whichever way they were sent.

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

/// Used by any thread.
class ActionInbox {
 public:
  /// @param taken Of what is taken. @param stored Hears of every commit. All outlive it.
  ActionInbox(KnownSpacecraft known, const Archive& archive, BoundedQueue<SampleBatch>& taken,
              StoredActions& stored)
      : known_{std::move(known)}, archive_{archive}, taken_{taken}, stored_{stored} {}

  /// Its place is behind the samples that are taken already, whether these leave room or not. It
  /// waits until the action is stored.
  /// @return its action_id; as parse_action; Unavailable where nothing more is taken, too many
  ///         wait, or it is not stored within 5 s.
  Expected<std::string> take(const nlohmann::json& request);

 private:
  KnownSpacecraft known_;
  const Archive& archive_;
  BoundedQueue<SampleBatch>& taken_;
  StoredActions& stored_;
};

}  // namespace spindrift
