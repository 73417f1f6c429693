/// @file
/// The operator actions that exclude or include telemetry of a three-axis spacecraft.

#pragma once

#include <variant>

#include "pipelines/exclusions/exclusions.h"
#include "pipelines/three_axis/products.h"

namespace spindrift {

using AttitudeAction = std::variant<ExcludeChannel<SampleKind>, IncludeChannel<SampleKind>,
                                    ExcludeSegment<SampleKind>>;

}  // namespace spindrift
