/// @file
/// Reads the [reconstruction] of a mission file, on the separation from the launcher.

#pragma once

#include <optional>

#include "pipelines/reconstruction/request.h"
#include "pipelines/reconstruction/separation.h"
#include "services/mission/document.h"

namespace spindrift {

struct SeparationPlan {
  SeparationTimes times;
  std::optional<LauncherAttitude> launcher;  ///< Empty when the file names none.
  double disturbance_rad_s2 = kDisturbance_rad_s2;
};

/// @param document Valid by the schema; receives problems of the launcher's keys.
/// @return Empty if there is no [reconstruction].
std::optional<SeparationPlan> separation_plan(TomlDocument& document);

}  // namespace spindrift
