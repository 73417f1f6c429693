#include "services/serving/action_inbox.h"

namespace spindrift {

Expected<std::string> ActionInbox::take(const nlohmann::json& request) {
  return parse_action(request, known_)
      .and_then([&](const OperatorAction& action) -> Expected<std::string> {
        if (const auto failure = archive_.statistics().failure) {
          return Unexpected{{ErrorCode::Unavailable,
                             "the archive does not store, so that the action would be lost: say "
                             "it again when it does: " +
                                 failure->message}};
        }
        SampleBatch batch;
        batch.actions.push_back(action);
        if (!taken_.push(std::move(batch))) {
          return Unexpected{{ErrorCode::Unavailable,
                             "the service is stopping and takes nothing more: say it again to the "
                             "next one"}};
        }
        return action.action_id;
      });
}

}  // namespace spindrift
