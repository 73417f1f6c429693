#include "services/mission/limits_in_force.h"

#include <iterator>

#include "services/mission/mission_alerts.h"

namespace spindrift {

const AlertLimits& LimitsInForce::at(TaiTime t) {
  if (from_.empty()) {
    work_out();
  }
  return std::prev(from_.upper_bound(t))->second;
}

void LimitsInForce::work_out() {
  TomlValues values = values_;
  from_.emplace(TaiTime::min(), alert_limits(values));
  for (const auto& [t, limit] : said_) {
    for (const auto& [name, value] : limit.limits) {
      values.insert_or_assign(limit_path(limit.key, name), value);
    }
    from_.insert_or_assign(t, alert_limits(values));
  }
}

}  // namespace spindrift
