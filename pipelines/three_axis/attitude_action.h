/// @file
/// What an operator may say of a three-axis spacecraft's telemetry from some instant on.

#pragma once

#include <variant>

#include "pipelines/exclusions/channel_actions.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

using AttitudeAction = std::variant<ExcludeChannel<SampleKind>, IncludeChannel<SampleKind>,
                                    ExcludeSegment<SampleKind>>;

}  // namespace spindrift
