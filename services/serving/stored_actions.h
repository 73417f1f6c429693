/// @file
/// Which operators' actions are handed on and not stored yet, for those who wait until they are.

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

/// Used by any thread.
class StoredActions {
 public:
  /// More are no word of a person, or the archive does not store.
  static constexpr std::size_t kMostAwaited = 64;

  /// Before the action is handed on. @return false when kMostAwaited are not stored yet.
  bool expect(const std::string& action_id);
  /// It is not handed on.
  void forget(const std::string& action_id);

  /// After each commit.
  void note(std::span<const ArchiveBatch> stored);

  /// Of one that is expected: waits until it is stored, so long at most. @return whether it is.
  bool wait(const std::string& action_id, std::chrono::seconds at_most);

 private:
  std::mutex mutex_;
  std::condition_variable stored_;
  std::set<std::string> awaited_;
};

}  // namespace spindrift
