/// @file
/// Tracks which operators' actions are queued and not stored yet.

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include "services/archive/records.h"

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
  void note(std::span<const ArchiveBatch> stored);

  /// Waits until a registered action is stored.
  /// @return False when it is not stored within `at_most`.
  bool wait(const std::string& action_id, std::chrono::seconds at_most);

 private:
  std::mutex mutex_;
  std::condition_variable stored_;
  std::set<std::string> awaited_;
};

}  // namespace spindrift
