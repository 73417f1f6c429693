/// @file
/// What a mission file says of the three-axis pipeline.

#pragma once

#include "pipelines/three_axis/config.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// @param values In which no problem was found.
ThreeAxisConfig three_axis_config(const TomlValues& values);

}  // namespace spindrift
