/// @file
/// From when to when what holds in a coming pass.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/spin/pass_plan.h"

namespace spindrift {

/// @param steps Of that scene, in order of time, at least one. Where something begins or ceases to
///        hold between two of them, the time is searched for.
/// @return As PassScene::at.
Expected<std::vector<PassEvent>> pass_events(PassScene& scene, const std::vector<PassStep>& steps);

}  // namespace spindrift
