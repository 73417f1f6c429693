#include "services/processor/action_effects.h"

#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace spindrift {
namespace {

NamedValue at(const OperatorAction& action) { return {"t_tai_ns", tai_ns(action.t.value())}; }

Notice of_limits(const OperatorAction& action, const SetLimit& set) {
  std::vector<std::string> limits;
  for (const auto& [name, value] : set.limits) {
    limits.push_back(fmt::format("{} {:g}", name, value));
  }
  return {NoticeCode::LimitsSet,
          {at(action),
           {"key", set.key},
           {"limits", std::move(limits)},
           {"action_id", action.action_id}}};
}

template <class Channel>
std::vector<Notice> of_use(const OperatorAction& action, const IncludeChannel<Channel>& what,
                           bool was_left_out) {
  return {{was_left_out ? NoticeCode::ChannelIncluded : NoticeCode::ChannelNotLeftOut,
           {at(action),
            {"channel", std::string{name_of(what.channel)}},
            {"action_id", action.action_id}}}};
}
template <class Other>
std::vector<Notice> of_use(const OperatorAction& /*action*/, const Other& /*what*/,
                           bool /*was_left_out*/) {
  return {};
}

}  // namespace

std::vector<Notice> effects_of(const OperatorAction& action, bool was_left_out) {
  return std::visit(
      [&]<class Does>(const Does& does) -> std::vector<Notice> {
        if constexpr (std::is_same_v<Does, SetLimit>) {
          return {of_limits(action, does)};
        } else {
          return std::visit([&](const auto& what) { return of_use(action, what, was_left_out); },
                            does);
        }
      },
      action.does);
}

}  // namespace spindrift
