/// @file
/// Converts a mission file to the configuration of the three-axis pipeline.

#pragma once

#include "pipelines/three_axis/config.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// @param values Values of a mission file without problems.
ThreeAxisConfig three_axis_config(const TomlValues& values);

}  // namespace spindrift
