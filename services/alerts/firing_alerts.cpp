#include "services/alerts/firing_alerts.h"

#include <set>
#include <utility>

#include "pipelines/time/utc.h"

namespace spindrift {

nlohmann::json FiringAlerts::json_of(const OpenAlert& open, TaiTime now) const {
  const Alert& alert = open.alert;
  return {{"labels",
           {{"alertname", alert.key},
            {"spacecraft", open.spacecraft},
            {"severity", name_of(alert.severity)},
            {"service", service_}}},
          {"annotations",
           {{"summary", alert.message},
            {"alert_id", alert.alert_id},
            {"state", name_of(alert.state)},
            {"evidence", alert.evidence}}},
          {"startsAt", format_utc(alert.raised)},
          {"endsAt", format_utc(now + kEndsAfter)}};
}

nlohmann::json FiringAlerts::due(std::span<const OpenAlert> open, TaiTime now) {
  nlohmann::json due = nlohmann::json::array();
  std::set<std::string> firing;
  due_.clear();
  ended_.clear();
  for (const OpenAlert& one : open) {
    const std::string& id = one.alert.alert_id;
    if (one.alert.state == AlertState::Shelved) {
      continue;
    }
    firing.insert(id);
    const auto told = told_.find(id);
    if (told == told_.end() || told->second.revision != one.alert.revision ||
        now - told->second.when >= kAgain) {
      const auto entry = due_.emplace(
          id, Told{.revision = one.alert.revision, .when = now, .alert = json_of(one, now)});
      due.push_back(entry.first->second.alert);
    }
  }
  for (const auto& [id, told] : told_) {
    if (!firing.contains(id)) {
      ended_.push_back(id);
      due.push_back(told.alert);
      due.back()["endsAt"] = format_utc(now);
    }
  }
  return due;
}

void FiringAlerts::told(TaiTime now) {
  for (auto& [id, told] : due_) {
    told.when = now;
    told_.insert_or_assign(id, std::move(told));
  }
  for (const std::string& id : ended_) {
    told_.erase(id);
  }
  due_.clear();
  ended_.clear();
}

}  // namespace spindrift
