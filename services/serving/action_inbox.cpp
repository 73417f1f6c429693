#include "services/serving/action_inbox.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipelines/time/utc.h"
#include "services/archive/last_run.h"
#include "services/base/wall_clock.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPatience{5};
// What is planned further ahead is not of this pass.
constexpr std::chrono::hours kAhead{24};

}  // namespace

bool StoredActions::expect(const std::string& action_id) {
  const std::lock_guard lock{mutex_};
  return awaited_.size() < kMostAwaited && awaited_.insert(action_id).second;
}

void StoredActions::forget(const std::string& action_id) {
  const std::lock_guard lock{mutex_};
  awaited_.erase(action_id);
}

void StoredActions::confirm(std::span<const ArchiveBatch> stored) {
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

/// Before the first telemetry, nothing is known of the pass.
Expected<OperatorAction> ActionInbox::within_pass(OperatorAction action) const {
  const auto run = find_last_run(db_, action.spacecraft, mode_);
  if (!action.t || !run || !*run || !(*run)->first_sample || !(*run)->last_sample) {
    return action;
  }
  const TaiTime first = *(*run)->first_sample;
  const TaiTime end = std::max(*(*run)->last_sample, tai_now()) + kAhead;
  const auto segment = segment_in(action.does);
  if (*action.t <= end && (segment ? segment->to : *action.t) >= first) {
    return action;
  }
  return Unexpected{
      {ErrorCode::InvalidInput,
       fmt::format("{}: {} is outside the pass: must lie from its first sample, {}, to {}",
                   action.action, format_utc(*action.t), format_utc(first), format_utc(end))}};
}

Expected<std::string> ActionInbox::submit(const nlohmann::json& request) {
  return parse_action(request, known_)
      .and_then([&](const OperatorAction& action) { return within_pass(action); })
      .and_then([&](const OperatorAction& action) -> Expected<std::string> {
        if (const auto failure = archive_.statistics().failure) {
          return Unexpected{{ErrorCode::Unavailable,
                             "the archive does not store, so that the action would be lost: say "
                             "it again when it does: " +
                                 failure->message}};
        }
        SampleBatch batch;
        batch.actions.push_back(action);
        if (!stored_.expect(action.action_id)) {
          return Unexpected{{ErrorCode::Unavailable,
                             fmt::format("{} actions wait to be stored already: say it again when "
                                         "they are",
                                         StoredActions::kMostAwaited)}};
        }
        if (!taken_.push_at_once(std::move(batch))) {
          stored_.forget(action.action_id);
          return Unexpected{{ErrorCode::Unavailable,
                             "the service is stopping and takes nothing more: say it again to the "
                             "next one"}};
        }
        if (!stored_.wait(action.action_id, kPatience)) {
          return Unexpected{
              {ErrorCode::Unavailable,
               fmt::format("{} is not stored within {} s: it is taken, and done as soon as the "
                           "archive stores again; do not say it twice",
                           action.action_id, kPatience.count())}};
        }
        return action.action_id;
      });
}

}  // namespace spindrift
