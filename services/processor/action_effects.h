/// @file
/// What an operator's action does from its time on, for the operator to read.

#pragma once

#include <vector>

#include "pipelines/core/notice.h"
#include "services/telemetry/operator_action.h"

namespace spindrift {

/// Returns the notices of an action whose effect is known when it is taken.
/// @param was_left_out Whether the channel that it names was left out until now.
std::vector<Notice> effects_of(const OperatorAction& action, bool was_left_out);

}  // namespace spindrift
