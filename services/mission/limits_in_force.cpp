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
  from_.emplace(TaiTime::min(), from(TaiTime::min()));
  if (contact_) {
    from_.emplace(contact_->from, from(contact_->from));
    from_.emplace(contact_->to, from(contact_->to));
  }
  for (const auto& [t, limit] : said_) {
    from_.emplace(t, from(t));
  }
}

/// What an operator has said holds in every later phase too.
AlertLimits LimitsInForce::from(TaiTime t) const {
  TomlValues values = values_;
  if (contact_ && (t < contact_->from || t >= contact_->to)) {
    put_phase(t < contact_->from ? kBeforeContact : kAfterContact, values);
  }
  for (auto said = said_.begin(); said != said_.upper_bound(t); ++said) {
    for (const auto& [name, value] : said->second.limits) {
      values.insert_or_assign(limit_path(said->second.key, name), value);
    }
  }
  return alert_limits(values);
}

}  // namespace spindrift
