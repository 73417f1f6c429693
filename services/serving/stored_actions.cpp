#include "services/serving/stored_actions.h"

namespace spindrift {

bool StoredActions::expect(const std::string& action_id) {
  const std::lock_guard lock{mutex_};
  return awaited_.size() < kMostAwaited && awaited_.insert(action_id).second;
}

void StoredActions::forget(const std::string& action_id) {
  const std::lock_guard lock{mutex_};
  awaited_.erase(action_id);
}

void StoredActions::note(std::span<const ArchiveBatch> stored) {
  const std::lock_guard lock{mutex_};
  if (awaited_.empty()) {
    return;
  }
  for (const ArchiveBatch& batch : stored) {
    for (const OperatorAction& action : batch.actions) {
      awaited_.erase(action.action_id);
    }
  }
  stored_.notify_all();
}

bool StoredActions::wait(const std::string& action_id, std::chrono::seconds at_most) {
  std::unique_lock lock{mutex_};
  return stored_.wait_for(lock, at_most, [&] { return !awaited_.contains(action_id); });
}

}  // namespace spindrift
