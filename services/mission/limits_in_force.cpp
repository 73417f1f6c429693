#include "services/mission/limits_in_force.h"

#include "services/mission/mission_alerts.h"

namespace spindrift {

std::optional<AlertLimits> LimitsInForce::advance(TaiTime t) {
  const auto later = pending_.upper_bound(t);
  if (later == pending_.begin()) {
    return std::nullopt;
  }
  for (auto due = pending_.begin(); due != later; due = pending_.erase(due)) {
    for (const auto& [name, value] : due->second.limits) {
      values_.insert_or_assign(limit_path(due->second.key, name), value);
    }
  }
  return alert_limits(values_);
}

}  // namespace spindrift
