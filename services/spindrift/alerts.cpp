#include "services/spindrift/alerts.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/time/utc.h"
#include "services/alerts/stored_alerts.h"
#include "services/clock/wall_clock.h"
#include "services/products/products.h"
#include "services/products/to_json.h"
#include "services/requests/request_client.h"
#include "services/spindrift/outcome.h"
#include "services/words/json_line.h"

namespace spindrift {
namespace {

nlohmann::json to_json(const StoredAlert& stored) {
  nlohmann::json object = json_of(stored.alert);
  object["spacecraft_id"] = stored.spacecraft;
  object["run_id"] = stored.run_id;
  object["evidence"] = nlohmann::json::parse(stored.alert.evidence, nullptr, false);
  return object;
}

std::string to_text(const StoredAlert& stored) {
  const Alert& alert = stored.alert;
  return fmt::format("{} {} {} {} {} since {}: {}\n", alert.alert_id, stored.spacecraft,
                     name_of(alert.severity), name_of(alert.state), alert.key,
                     format_utc(alert.raised), alert.message);
}

/// What the operator asks for, done to an alert of `desk`.
Expected<ArchiveBatch> changed(AlertDesk& desk, const std::string& alert_id, const std::string& by,
                               const std::string& note, int minutes) {
  const TaiTime now = tai_now();
  return minutes > 0 ? desk.shelve(alert_id, now, now + std::chrono::minutes{minutes}, by, note)
                     : desk.acknowledge(alert_id, now, by, note);
}

std::string done_text(const ArchiveBatch& batch) {
  const Alert& alert = std::get<Alert>(batch.products.front());
  return fmt::format("{} {} {}\n", alert.alert_id, alert.key, name_of(alert.state));
}

/// Holds the archive before it looks, so that nobody else's word comes between.
Expected<std::string> changed_here(const AlertsOptions& options) {
  auto archive = find_alerts(options.db).and_then([&](const auto& /*an archive it is*/) {
    return Archive::open(options.db, {});
  });
  if (!archive) {
    return Unexpected{archive.error()};
  }
  const auto stored = find_alerts(options.db);
  if (!stored) {
    return Unexpected{stored.error()};
  }
  AlertDesk desk;
  for (const StoredAlert& one : *stored) {
    desk.take_up(one.spacecraft, one.run_id, one.alert);
  }
  auto batch = changed(desk, options.alert_id, options.by, options.note, options.minutes);
  if (!batch) {
    return Unexpected{{ErrorCode::InvalidConfiguration, batch.error().message}};
  }
  const std::string text = done_text(*batch);
  const auto submitted = (*archive)->submit(*std::move(batch));
  return outcome_of(submitted, (*archive)->close()).map([&] { return text; });
}

}  // namespace

Expected<void> list_alerts(const AlertsOptions& options) {
  return find_alerts(options.db).map([&](const std::vector<StoredAlert>& alerts) {
    nlohmann::json all = nlohmann::json::array();
    for (const StoredAlert& stored : alerts) {
      if (options.json) {
        all.push_back(to_json(stored));
      } else if (stored.alert.state != AlertState::Cleared) {
        fmt::print("{}", to_text(stored));
      }
    }
    if (options.json) {
      fmt::print("{}", json_line({{"alerts", std::move(all)}}));
    }
  });
}

Expected<void> change_alert(const AlertsOptions& options) {
  const auto answer = ask_holder(options.db, {{"do", kAlertRequest},
                                              {"alert_id", options.alert_id},
                                              {"by", options.by},
                                              {"note", options.note},
                                              {"minutes", options.minutes}});
  if (!answer) {
    return Unexpected{answer.error()};
  }
  if (!*answer) {
    return changed_here(options).map([](const std::string& text) { fmt::print("{}", text); });
  }
  if (const auto error = (**answer).find("error"); error != (**answer).end()) {
    return Unexpected{{ErrorCode::InvalidConfiguration, error->get<std::string>()}};
  }
  fmt::print("{}", (**answer).value("text", ""));
  return {};
}

nlohmann::json answer_alert(const nlohmann::json& request, AlertDesk& desk, Archive& archive) {
  auto batch = changed(desk, request.value("alert_id", ""), request.value("by", ""),
                       request.value("note", ""), request.value("minutes", 0));
  if (!batch) {
    return {{"error", batch.error().message}};
  }
  const std::string text = done_text(*batch);
  const auto stored = archive.submit(*std::move(batch)).and_then([&] { return archive.flush(); });
  return stored ? nlohmann::json{{"text", text}}
                : nlohmann::json{{"error", stored.error().message}};
}

}  // namespace spindrift
