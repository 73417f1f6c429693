#include "pipelines/supervision/sensor_conditions.h"

#include <chrono>
#include <utility>

namespace spindrift {
namespace {

// It may take some seconds until the other sensors, too, show which of two is wrong.
constexpr Holding kUnknown{.raise_s = 5.0, .clear_s = 30.0};
// A wrong gyro shows in slews only.
constexpr Holding kNamed{.raise_s = 0.0, .clear_s = 30.0};

/// Adds what is known of the contradiction, also while its condition clears.
void describe(const SensorContradiction& last, ConditionChange& change) {
  change.who = opponents_text(last);
  change.evidence.since = last.since;
  change.evidence.more = {last.off, {"sigma", last.sigmas}, {"with", opponents_of(last)}};
}

}  // namespace

SensorConditions::Culprit::Culprit(const std::string& name)
    : watch{AlertCode::SensorContradicts, "sigma", name == kUnknownCulprit ? kUnknown : kNamed,
            name} {}

ConditionChanges SensorConditions::evaluate(TaiTime t,
                                            const std::optional<SensorContradiction>& found) {
  judged_ = t;
  now_ = found;
  const std::string name_found = found ? culprit_name_of(*found) : std::string{};
  if (found) {
    culprits_.try_emplace(name_found, name_found).first->second.last = found;
  }
  ConditionChanges changes;
  for (auto& [name, culprit] : culprits_) {
    auto change = culprit.watch.update(
        t, {.value = name == name_found ? found->sigmas : 0.0, .limit = limit_sigmas_});
    if (change && change->change != Change::Cleared && culprit.last) {
      describe(*culprit.last, *change);
    }
    add(std::move(change), changes);
  }
  return changes;
}

ConditionChanges SensorConditions::settle() {
  if (!judged_) {
    return {};
  }
  for (auto& [name, culprit] : culprits_) {
    culprit.watch.end();
  }
  // Behind all that was judged, since a change at the time of another would be taken for known.
  return evaluate(*judged_ + std::chrono::nanoseconds{1}, std::optional{now_});
}

}  // namespace spindrift
