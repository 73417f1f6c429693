#include "pipelines/supervision/sensor_conditions.h"

#include <utility>

namespace spindrift {
namespace {

// It may take some seconds until the other sensors, too, show which of two is wrong.
constexpr Holding kUnknown{.raise_s = 10.0, .clear_s = 30.0};
// A wrong gyro shows in slews only.
constexpr Holding kNamed{.raise_s = 0.0, .clear_s = 30.0};

}  // namespace

ConditionChanges SensorConditions::evaluate(TaiTime t,
                                            const std::optional<SensorContradiction>& found) {
  const std::string culprit = found ? culprit_name_of(*found) : std::string{};
  if (found) {
    watches_.try_emplace(culprit, AlertCode::SensorContradicts, "sigma",
                         found->culprit ? kNamed : kUnknown, culprit);
  }
  ConditionChanges changes;
  for (auto& [name, watch] : watches_) {
    const bool is_it = name == culprit;
    auto change = watch.update(t, {.value = is_it ? found->sigmas : 0.0, .limit = limit_sigmas_});
    if (change && is_it) {
      change->who = opponents_text(*found);
      change->evidence.since = found->since;
      change->evidence.more = {
          found->off, {"sigma", found->sigmas}, {"with", opponents_of(*found)}};
    }
    add(std::move(change), changes);
  }
  return changes;
}

}  // namespace spindrift
