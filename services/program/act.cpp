#include <fmt/format.h>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/base/json_line.h"
#include "services/base/warning.h"
#include "services/operator/request_socket.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/requests.h"

namespace spindrift {
namespace {

Expected<nlohmann::json> request_of(const ActOptions& options) {
  nlohmann::json request{{"do", kActionRequest},
                         {"spacecraft", options.spacecraft},
                         {"action", options.action},
                         {"by", options.by},
                         {"note", options.note}};
  const auto add = [&](const char* key, const auto& value) {
    if (value) {
      request[key] = *value;
    }
  };
  add("channel", options.channel);
  add("ra_deg", options.ra_deg);
  add("dec_deg", options.dec_deg);
  add("sigma_deg", options.sigma_deg);
  add("key", options.key);
  for (const auto& [name, limit] : options.limits) {
    request[name] = limit;
  }
  const std::array<std::pair<const char*, const std::optional<std::string>&>, 3> times{
      {{"t_tai_ns", options.at}, {"from_tai_ns", options.from}, {"to_tai_ns", options.to}}};
  for (const auto& [key, utc] : times) {
    if (utc) {
      const auto t = parse_utc(*utc);
      if (!t) {
        return refused(t.error().message);
      }
      request[key] = tai_ns(*t);
    }
  }
  return request;
}

}  // namespace

Expected<void> act(const ActOptions& options) {
  const auto request = request_of(options);
  if (!request) {
    return Unexpected{request.error()};
  }
  const auto answer = ask_holder(options.db, *request);
  if (!answer) {
    return Unexpected{answer.error()};
  }
  if (!*answer) {
    return Unexpected{
        {ErrorCode::Unavailable,
         fmt::format(
             "{}: no service holds it: an action is for the telemetry that a service takes; "
             "start `spindrift serve` with this archive, then say it again",
             shown(options.db.string()))}};
  }
  if (const auto error = (**answer).find("error"); error != (**answer).end()) {
    return refused(error->get<std::string>());
  }
  fmt::print("{}", options.json ? json_line(with_warnings(**answer))
                                : fmt::format("{}\n", (**answer).value("action_id", "")));
  return {};
}

nlohmann::json answer_action(nlohmann::json request, ActionInbox& inbox) {
  request.erase("do");
  const auto taken = inbox.submit(request);
  return taken ? nlohmann::json{{"action_id", *taken}}
               : nlohmann::json{{"error", taken.error().message}};
}

}  // namespace spindrift
