#include "services/serving/action_inbox.h"

namespace spindrift {

Expected<std::string> ActionInbox::take(const nlohmann::json& request) {
  return parse_action(request, known_)
      .and_then([&](const OperatorAction& action) -> Expected<std::string> {
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
