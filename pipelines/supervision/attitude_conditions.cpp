#include "pipelines/supervision/attitude_conditions.h"

#include <optional>
#include <utility>

namespace spindrift {
namespace {

ConditionChanges changes_of(std::optional<ConditionChange> change) {
  return change ? ConditionChanges{std::move(*change)} : ConditionChanges{};
}

}  // namespace

AttitudeConditions::AttitudeConditions(const AlertLimits& limits)
    : launcher_percent_{limits.launcher_percent},
      lost_{AlertCode::AttitudeLost, "s"},
      launcher_{AlertCode::ReconstructionLauncher, "% of chi-square"} {}

ConditionChanges AttitudeConditions::see(const AttitudeEstimate& estimate) {
  return changes_of(lost_.see(estimate.t, estimate.assessment.quality == Quality::Lost));
}

ConditionChanges AttitudeConditions::see(const ReconstructedSeparation& separation) {
  // That of `batch`, which rests on all samples together.
  if (separation.solution.method != ReconstructionMethod::Batch || !separation.launcher ||
      !*separation.launcher) {
    return {};
  }
  return changes_of(launcher_.see(
      separation.solution.history.back().t,
      {.value = 100.0 * (1.0 - (**separation.launcher).chance), .limit = launcher_percent_}));
}

}  // namespace spindrift
