/// @file
/// What a mission file says of the separation from the launcher.

#pragma once

#include <optional>

#include "pipelines/reconstruction/launcher_check.h"
#include "pipelines/reconstruction/request.h"
#include "services/mission/document.h"

namespace spindrift {

struct SeparationPlan {
  SeparationTimes times;
  std::optional<LauncherAttitude> launcher;  ///< Empty: it told nothing.
  double disturbance_rad_s2 = kDisturbance_rad_s2;
};

/// @param document In which no problem was found by the schema; gets those of the launcher's chain.
/// @return empty where there is no [reconstruction].
std::optional<SeparationPlan> separation_plan(TomlDocument& document);

}  // namespace spindrift
