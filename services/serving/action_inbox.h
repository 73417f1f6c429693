/// @file
/// Accepts operators' actions into the running service, whichever way they were sent.

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "pipelines/core/expected.h"
#include "services/archive/archive.h"
#include "services/archive/records.h"
#include "services/base/bounded_queue.h"
#include "services/operator/parse_action.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Lets callers wait until their actions are stored. May be used by any thread.
class StoredActions {
 public:
  /// More waiting actions are not entered by people, or the archive does not store.
  static constexpr std::size_t kMostAwaited = 64;

  /// Registers an action before it is queued.
  /// @return False when kMostAwaited actions are not stored yet.
  bool expect(const std::string& action_id);
  void forget(const std::string& action_id);

  /// Notes the actions stored by a commit.
  void confirm(std::span<const ArchiveBatch> stored);

  /// Waits until a registered action is stored.
  /// @return False when it is not stored within `at_most`.
  bool wait(const std::string& action_id, std::chrono::seconds at_most);

 private:
  std::mutex mutex_;
  std::condition_variable stored_;
  std::set<std::string> awaited_;
};

/// Accepts operators' actions. May be used by any thread.
class ActionInbox {
 public:
  /// All arguments must outlive the inbox. @param db Path of the archive. @param mode Mode of the
  /// runs that the actions are for. @param taken Queue that the actions go into.
  /// @param stored Is told of every commit.
  ActionInbox(KnownSpacecraft known, std::filesystem::path db, RunMode mode, const Archive& archive,
              BoundedQueue<SampleBatch>& taken, StoredActions& stored)
      : known_{std::move(known)},
        db_{std::move(db)},
        mode_{mode},
        archive_{archive},
        taken_{taken},
        stored_{stored} {}

  /// Queues an action behind the samples that are queued already, even if the queue is full, and
  /// waits until it is stored. @return The action_id; errors as parse_action; InvalidInput for a
  /// time before the first sample of the pass or a day after the last; Unavailable when the
  /// service stops, too many actions wait, or the action is not stored within 5 s.
  Expected<std::string> submit(const nlohmann::json& request);

 private:
  Expected<OperatorAction> within_pass(OperatorAction action) const;

  KnownSpacecraft known_;
  std::filesystem::path db_;
  RunMode mode_;
  const Archive& archive_;
  BoundedQueue<SampleBatch>& taken_;
  StoredActions& stored_;
};

}  // namespace spindrift
