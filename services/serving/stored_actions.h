/// @file
/// Which operators' actions the archive has stored, for those who wait for that.

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include "services/archive/records.h"

namespace spindrift {

/// Used by any thread.
class StoredActions {
 public:
  /// Before the action is handed on.
  void expect(const std::string& action_id);

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
